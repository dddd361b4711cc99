#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/ports/debian.sh bookworm|trixie|sid [view|packages]
# Makes a bare Debian of that name in build-NAME/ from the mirrors that apt has here, copies this tree and ../shared into
# it, and runs scenes/view.sh and, without `view`, tests/run.sh there, as a user would; with `packages`, it makes the Debian
# packages instead, in build-NAME/src/osgGpuAnimation/build-deb/. What build-NAME/ has already is kept and used again. Needs
# root. Exit status 0: all passed. Sid changes daily, so its result has a date.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

name=${1:-}
if [[ ! "$name" =~ ^(bookworm|trixie|sid)$ ]] || [[ ! "${2:-view}" =~ ^(view|packages)$ ]]; then
    sed -n '3,7s/^# //p' "${BASH_SOURCE[0]}"
    exit 2
fi
folder=$root/build-$name

# The machine's own mirrors of Debian, with this release; sid has no updates apart.
sources()
{
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
        sed -nE "s/^(deb [^ ]+ )[a-z]+(-updates|-security)? main$/\1$name\2 main/p" | sort -u |
        if [ "$name" = sid ]; then grep ' sid main$'; else cat; fi
}

# What apt here needs to reach its mirrors. A mirror's copy of sid may be older than its date allows.
settings()
{
    apt-config dump --no-empty Acquire::http
    apt-config dump --no-empty Acquire::https
    echo 'Acquire::Check-Valid-Until "false";'
}

# In the bare system, with this machine's devices (terminals), and with processes and mounts of its own that end with it;
# OSGGPUANIMATION_… of the environment are passed.
inside()
{
    local passed
    mapfile -t passed < <(env | grep '^OSGGPUANIMATION_')
    unshare --mount --pid --fork --kill-child --mount-proc="$folder/proc" \
        sh -c 'mount --rbind /dev "$0/dev" && exec chroot "$0" "$@"' "$folder" \
        env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root "${passed[@]}" "$@"
}

install_missing mmdebstrap git
if [ ! -d "$folder/src" ]; then # which is made last
    rm -rf "$folder"
    mkdir -p "$folder"
    aptopt=$(mktemp) && chmod 644 "$aptopt"
    trap 'rm -f "$aptopt"' EXIT
    settings >"$aptopt"
    sources | mmdebstrap --variant=minbase --aptopt="$aptopt" "$name" "$folder" -
fi

tree=/src/osgGpuAnimation
mkdir -p "$folder$tree"
find "$folder$tree" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf '{}' +
git -C "$root" -c safe.directory='*' ls-files -z --cached --others --exclude-standard |
    tar -C "$root" --null --files-from=- -c | tar -C "$folder$tree" -x
if [ $# -eq 1 ] && [ -d "$root/../shared" ]; then # the tests need it
    rm -rf "$folder/src/shared"
    cp -rL "$root/../shared" "$folder/src/shared"
fi

# Runs in the tree, inside.
make_packages='
    source tests/setup.sh
    build=$root/build-deb
    install_missing "${view_packages[@]}" dpkg-dev file
    configure_release -DCMAKE_INSTALL_PREFIX=/usr && build_targets
    cd "$build" && cpack
'
if [ "${2:-}" = packages ]; then
    inside sh -c 'cd "$0" && exec bash -euo pipefail -c "$1"' "$tree" "$make_packages" </dev/null
    exit
fi

echo "Debian $name ($(cat "$folder/etc/debian_version")) on $(date -u +%F): scenes/view.sh"
time inside "$tree/scenes/view.sh" </dev/null
[ -s "$folder$tree/build/Wanderer.png" ] || { echo "scenes/view.sh drew no picture" >&2; exit 1; }
[ $# -eq 1 ] || exit 0
echo "Debian $name: tests/run.sh"
export OSGGPUANIMATION_REQUIRE_GL=1
time inside "$tree/tests/run.sh" </dev/null
