#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/gpu/bare.sh [PART...], after tests/gpu/pack.sh; as root
# Runs go.sh in a bare chroot, without the repository, its build and the libraries of both: copies of the installed
# packages that go.sh needs, with Mesa's software renderer. OUT, LIMIT, FILTER, GPU and BENCH are those of
# go.sh.
# Exit status: go.sh's.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

packages=(bash dash coreutils findutils grep sed mawk tar xz-utils libc-bin
    python3 python3-skimage python3-scipy python3-pil libegl-mesa0 libgl1-mesa-dri)
[ -f "$root/.gpu/pack.tar.xz" ] || { echo "bare.sh: there is no .gpu; tests/gpu/pack.sh makes it" >&2; exit 1; }

bare=$(mktemp -d)
trap 'rm -rf "$bare"' EXIT
mkdir -p "$bare"/usr/{bin,sbin,lib,lib64} "$bare"/{dev,tmp,gpu}
for folder in bin sbin lib lib64; do
    ln -s "usr/$folder" "$bare/$folder"
done
mknod -m 666 "$bare/dev/null" c 1 3
mknod -m 666 "$bare/dev/zero" c 1 5
mknod -m 666 "$bare/dev/full" c 1 7
mknod -m 666 "$bare/dev/urandom" c 1 9
apt-cache depends --recurse --installed --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces \
    --no-enhances "${packages[@]}" | grep '^[a-z0-9]' | sort -u >"$bare/packages"
# Links to /etc/alternatives are made when packages are installed.
{
    xargs dpkg-query -L <"$bare/packages"
    find /etc/alternatives /usr/bin /usr/lib/x86_64-linux-gnu -maxdepth 1 -type l \
        \( -path '/etc/alternatives/*' -o -lname '/etc/alternatives/*' \)
} | grep '^/' | grep -vE '^/usr/share/(doc|man|locale)/' | sort -u >"$bare/files"
tar -C / -cP --no-recursion --ignore-failed-read -T "$bare/files" 2>"$bare/missing" | tar -C "$bare" -x
chroot "$bare" ldconfig
cp "$root"/.gpu/{go.sh,pack.tar.xz} "$bare/gpu"

status=0
env -i PATH=/usr/bin:/usr/sbin LIMIT="${LIMIT:-}" FILTER="${FILTER:-}" GPU="${GPU:-}" BENCH="${BENCH:-}" OUT=/gpu/out \
    chroot "$bare" bash /gpu/go.sh "$@" || status=$?
mkdir -p "${OUT:=$root/.gpu/out}"
rm -f "$OUT"/{{tests,poses,looks,gpu,bench}.log,{table,gpu}.md,pictures.tar.xz,{gpu,benchmark}.json} # of an earlier run, as go.sh does
[ ! -d "$bare/gpu/out" ] || cp -r "$bare/gpu/out/." "$OUT"
exit $status
