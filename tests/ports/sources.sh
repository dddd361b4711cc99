# SPDX-License-Identifier: MIT
# For `source`: fetch_sources FOLDER PACKAGE... unpacks Debian's source packages of this release, without later updates,
# which not every mirror has, as FOLDER/sources/PACKAGE, unless they are there.
fetch_sources()
{
    local folder=$1 package missing=()
    local options=(-o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
        -o "Dir::State::Lists=$folder/lists")
    for package in "${@:2}"; do
        [ -d "$folder/sources/$package" ] || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    mkdir -p "$folder/lists/partial" "$folder/sources"
    apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
        grep -E ' [a-z]+ main$' | sort -u >"$folder/sources.list"
    apt-get "${options[@]}" update -q
    rm -rf "$folder/fetched"
    mkdir "$folder/fetched"
    (cd "$folder/fetched" && apt-get "${options[@]}" source -q "${missing[@]}")
    for package in "${missing[@]}"; do
        mv "$folder/fetched/$package"-[0-9]*/ "$folder/sources/$package"
    done
}
