#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: [OUT=FOLDER] [LIMIT=SECONDS] go.sh [PART...]
# Runs what tests/gpu/pack.sh packed, on a machine with a graphics card; a software renderer serves, too. Parts:
#     tests   the GL tests but those of glslangValidator (FILTER: others, as for --gtest_filter)
#     poses   the oracle's poses, evaluated by the card, within 1e-5 of the model's size
#     looks   pictures against the reference pictures
#     gpu     the benchmark's page of the choices that a card decides, in less than four minutes (GPU: further options)
#     bench   the benchmark (BENCH: its options)
# Default: all, in this order, within LIMIT seconds together (560). The machine needs a driver with EGL and OpenGL 3.3,
# bash and xz; python3 for poses; scikit-image and SciPy for looks. OUT (default: out/ beside this file) gets the logs,
# gpu.md, gpu.json, benchmark.json and table.md, which is printed last; results of an earlier run are deleted there.
# Exit status 0: everything that was asked for ran and passed.
set -euo pipefail

sections=nodes,skins,weights,positions,bbox # as in tests/tool/oracle.cmake
read -ra options <<<"${BENCH:---quick --only pose --only crowd --only field --only mixed}"
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
unpacked=$here/unpacked # with everything that is written besides OUT
project=$unpacked/project
shared=$unpacked/shared
build=$project/build
logs=$unpacked/logs
tool=$build/bin/osggpuanim
mkdir -p "${OUT:=$here/out}"
out=$(cd "$OUT" && pwd)
faults=0

fail()
{
    echo "go.sh: $*" >&2
    exit 1
}

unpack()
{
    [ -f "$here/pack.tar.xz" ] || fail "there is no $here/pack.tar.xz; tests/gpu/pack.sh makes it"
    rm -rf "$unpacked"
    mkdir -p "$logs"
    tar -C "$unpacked" -xJf "$here/pack.tar.xz"
}

check_pack()
{
    local part
    for part in paths tests parts; do
        [ -s "$unpacked/$part" ] || fail "$part is not in the pack"
    done
    while read -r part; do
        [ -e "$unpacked/$part" ] || fail "$part is not in the pack"
    done <"$unpacked/parts"
    mapfile -t tests <"$unpacked/tests"
}

# The machine's own libraries are newer, and its driver may need that.
prefer_libraries_of_machine()
{
    /sbin/ldconfig -p | awk '/x86-64/ { print $1 }' | (cd "$unpacked/libraries" && xargs rm -f --)
}

# The paths that the tests were compiled with.
link_paths()
{
    local root folder part
    { read -r root && read -r folder; } <"$unpacked/paths"
    for part in build scenes; do
        link "$project/$part" "$root/$part"
    done
    link "$shared" "$folder"
    [ "$root/build" -ef "$build" ] || fail "the tests would use $root/build; tests/gpu/bare.sh runs them apart from it"
}

link()
{
    [ -e "$2" ] || { mkdir -p "$(dirname "$2")" && ln -sfn "$1" "$2"; } ||
        fail "cannot create $2, which the tests were compiled with"
}

# The driver of a container with NVIDIA's has a folder of its own.
find_driver()
{
    local vendor folder
    for vendor in {/usr/local/nvidia,/usr}/share/glvnd/egl_vendor.d/10_nvidia.json; do
        [ -f "$vendor" ] || continue
        export __EGL_VENDOR_LIBRARY_FILENAMES=$vendor
        export OSGGPUANIMATION_EGL_PLATFORM=${OSGGPUANIMATION_EGL_PLATFORM:-device}
        break
    done
    # OSG finds its plugins beside libraries; in tests of their absence it must not find the kit's.
    ln -s "$build"/lib/*.so* "$unpacked/libraries"
    export LD_LIBRARY_PATH=$unpacked/libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
    export OSG_LIBRARY_PATH=$build/lib OSGGPUANIMATION_REQUIRE_GL=1
    for folder in /usr/local/nvidia/lib{64,}; do
        [ ! -d "$folder" ] || LD_LIBRARY_PATH+=:$folder
    done
}

# What draws.
describe()
{
    local pose=$unpacked/pose.json status=0
    timed nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null || true
    timed "$tool" pose "$project/scenes/Wanderer.glb" --bind --evaluator gpu -o "$pose" >"$unpacked/log" 2>&1 ||
        status=$?
    [ $status -eq 0 ] || fail "the tool does not evaluate a pose, exit status $status: $(cat "$unpacked/log")"
    grep -soE 'osggpuanim, GPU: [^"]+' "$pose" || fail "the tool's pose names no GPU"
}

# Runs a command until LIMIT at most; exit status 124: the time is over.
timed()
{
    local left=$((${LIMIT:-560} - SECONDS))
    [ $left -gt 0 ] || { echo "no time is left"; return 124; }
    timeout --kill-after=5 $left "$@"
}

# A row of the table: begin, then try COMMAND... for each check, then end.
begin()
{
    part=$1 began=$SECONDS names=()
}

# try NAME COMMAND...: starts the command when a processor is free.
try()
{
    names+=("$1")
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do
        wait -n || true
    done
    {
        status=0
        timed "${@:2}" >"$logs/$1" 2>&1 || status=$?
        echo $status >"$logs/$1.status"
    } &
}

# Waits for all that was tried.
finish()
{
    local name
    wait
    for name in "${names[@]}"; do
        { echo "== $name"; cat "$logs/$name"; } >>"$out/$part.log"
    done
}

end()
{
    local name passed=0 failed=()
    finish
    for name in "${names[@]}"; do
        if [ "$(<"$logs/$name.status")" -eq 0 ]; then
            passed=$((passed + 1))
        else
            failed+=("$name")
        fi
    done
    row "$part" "$passed" ${#names[@]} "${failed[@]}"
}

# row NAME PASSED COUNT FAILED...
row()
{
    local failed=("${@:4}")
    [ "$3" -gt 0 ] || failed+=("nothing ran")
    [ ${#failed[@]} -eq 0 ] || faults=$((faults + 1))
    [ ${#failed[@]} -le 12 ] || failed=("${failed[@]:0:12}" "and $((${#failed[@]} - 12)) more")
    echo "| $1 | $2 of $3 | $((SECONDS - began)) s | ${failed[*]:-–} |" | tee -a "$out/table.md"
}

# Each program's tests in several processes, where there are processors for them; a row for each program.
run_tests()
{
    local program process processes=$((($(nproc) + ${#tests[@]} - 1) / ${#tests[@]}))
    begin tests
    for program in "${tests[@]}"; do
        for ((process = 0; process < processes; ++process)); do
            try "$program.$process" env GTEST_TOTAL_SHARDS=$processes GTEST_SHARD_INDEX=$process \
                "$build/bin/$program" --gtest_filter="${FILTER:-*GLTest*-ShaderLanguageGLTest.*}"
        done
    done
    finish
    for program in "${tests[@]}"; do
        count_tests "$program"
    done
}

count_tests()
{
    local log passed=0 count=0 failed=() ran done status
    for log in "$logs/$1".*[0-9]; do
        status=$(<"$log.status")
        ran=$(sed -nE 's/^\[=+\] Running ([0-9]+) tests? from.*/\1/p' "$log")
        done=$(grep -c '^\[       OK' "$log") || true
        # Failed and skipped tests, and the last one of a process that crashed or ran out of time.
        sed -nE 's/^\[  (FAILED|SKIPPED) +\] ([^ ,]+\.[^ ,]+).*/\2/p' "$log" | sort -u >"$unpacked/names"
        mapfile -t -O ${#failed[@]} failed <"$unpacked/names"
        if [ "$status" -gt 1 ]; then
            failed+=("$(sed -n 's/^\[ RUN      \] //p' "$log" | tail -1): exit status $status")
        elif [ ! -s "$unpacked/names" ] && { [ "$status" -eq 1 ] || [ "$done" -ne "${ran:-0}" ]; }; then
            failed+=("exit status $status")
        fi
        count=$((count + ${ran:-0}))
        passed=$((passed + done))
    done
    row "$1" $passed $count "${failed[@]}"
}

run_poses()
{
    local file
    begin poses
    for file in "$shared"/oracle/*.json; do
        try "$(basename "$file" .json)" \
            python3 tests/tool/check_oracle.py "$tool" gpu "$shared" "$(basename "$file")" $sections
    done
    end
}

run_looks()
{
    local file
    begin looks
    mkdir -p "$unpacked/pictures"
    for file in "$shared"/looks/pictures/*.png; do
        [[ $file != *.integrated.png ]] || continue
        try "$(basename "$file" .png)" \
            python3 tests/tool/check_looks.py "$tool" "$shared" "$(basename "$file" .png)" "$unpacked/pictures"
    done
    end
    tar -C "$unpacked" -c pictures | xz >"$out/pictures.tar.xz"
}

run_gpu()
{
    local file more=()
    read -ra more <<<"${GPU:-}"
    begin gpu
    try gpu "$build/bin/osggpuanim_benchmark" "$unpacked/gpu" "$shared"/assets/{Fox/Fox,Knight/Knight}.glb \
        --only gpu "${more[@]}"
    end
    for file in gpu.md gpu.json; do
        [ ! -f "$unpacked/gpu/$file" ] || cp "$unpacked/gpu/$file" "$out"
    done
    cat "$out/gpu.log"
}

run_bench()
{
    begin bench
    try bench "$build/bin/osggpuanim_benchmark" "$unpacked/bench" \
        "$shared"/assets/{Fox/Fox,CesiumMan/CesiumMan,Knight/Knight}.glb "${options[@]}"
    end
    [ ! -f "$unpacked/bench/benchmark.json" ] || cp "$unpacked/bench/benchmark.json" "$out"
    cat "$out/bench.log"
}

[ $# -gt 0 ] || set -- tests poses looks gpu bench
modules=json
for part in "$@"; do
    [[ " tests poses looks gpu bench " == *" $part "* ]] || fail "expected tests, poses, looks, gpu or bench, found $part"
    [ "$part" != looks ] || modules=skimage,scipy,PIL
done
[[ " $* " != *" looks "* && " $* " != *" poses "* ]] || python3 -c "import $modules" || fail "python3 needs $modules"
rm -f "$out"/{{tests,poses,looks,gpu,bench}.log,{table,gpu}.md,pictures.tar.xz,{gpu,benchmark}.json} # of an earlier run
unpack
check_pack
cd "$project"
link_paths
prefer_libraries_of_machine
find_driver
{
    describe
    printf '\n%s\n%s\n' '| part | passed | time | not passed |' '| --- | --- | --- | --- |'
} >"$out/table.md"
for part in "$@"; do
    "run_$part"
done
echo
cat "$out/table.md"
[ $faults -eq 0 ]
