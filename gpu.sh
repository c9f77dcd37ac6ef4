#!/usr/bin/env bash
# Measures and checks everything that needs a GPU, in less than eight minutes.
#
#   gpu.sh [OUT [MODEL …]]            run; the results are in OUT (npr-out/gpu) and there in a folder named by the device
#   gpu.sh build                      build what is run, into target/gpu-binaries
#   gpu.sh pack FILE.tar.gz [MODEL …] the same, stripped, packed with this script and the models; unpack it anywhere and
#                                     run npr-gpu/gpu.sh there
#
# A step that fails or takes too long does not stop the next ones. The end of the output and summary.md list the status of
# each, and the script's own status is 1 if any failed.
#
# NPR_BIN      a folder with prebuilt binaries; by default bin/ beside this script, else they are built by cargo first
# NPR_PROFILE  the cargo profile to build with (release)
# NPR_SIZE     the size of all pictures instead of 3840x2160 and, for benches, 1280x720; a small one for a trial
# NPR_FRAMES   the frames between two waits for the adapter, in benches (what each finds best)
# NPR_ROUNDS   the rounds of benches (what each finds best)
# NPR_SECONDS  the time for all steps (470)
# NPR_MODELS   the folder where benches look for stanford-bunny.obj
set -u
here="$(cd "$(dirname "$0")" && pwd)"
say() { printf 'gpu.sh: %s\n' "$*"; }
fail() {
    say "$*" >&2
    exit 1
}

programs=(npr frame shadow hatch passes outline-tests imagespace-tests)
built="$here/target/gpu-binaries"

# One command for all, so that they share their dependencies. Benches bring the command with them.
build() {
    cd "$here" || exit 1
    mkdir -p "$built" || exit 1
    local messages="$built/messages.json" program package kind target path
    set -- cargo bench --no-run --profile "${NPR_PROFILE:-release}" -p npr-harness -p npr-outline -p npr-imagespace \
        --features npr-outline/wgpu,npr-imagespace/wgpu \
        --bench frame --bench shadow --bench hatch --bench passes --test gpu
    say "$*"
    "$@" --message-format=json-render-diagnostics >"$messages" || fail "the programs were not built"
    while read -r program package kind target; do
        path="$(grep "/$package#.*\"kind\":\[\"$kind\"\].*\"name\":\"$target\"" "$messages" |
            sed -n 's/.*"executable":"\([^"]*\)".*/\1/p' | tail -n 1)"
        if [ -z "$path" ]; then fail "$program was not built"; fi
        cp "$path" "$built/$program" || exit 1
    done <<PROGRAMS
npr npr-harness bin npr
frame npr-harness bench frame
shadow npr-harness bench shadow
hatch npr-harness bench hatch
passes npr-imagespace bench passes
outline-tests npr-outline test gpu
imagespace-tests npr-imagespace test gpu
PROGRAMS
    rm "$messages"
    git rev-parse HEAD >"$built/commit" 2>/dev/null || true
}

# Sets `bin` to the folder of the programs.
find_programs() {
    if [ -n "${NPR_BIN:-}" ]; then
        bin="$(cd "$NPR_BIN" && pwd)" || exit 1
    elif [ -x "$here/bin/npr" ]; then
        bin="$here/bin"
    elif command -v cargo >/dev/null 2>&1 && [ -f "$here/Cargo.toml" ]; then
        (build) || exit 1
        bin="$built"
    else
        fail "no programs: set NPR_BIN, or run this in a checkout with cargo"
    fi
}

pack() {
    local file=$1 name
    shift
    find_programs
    folder="$(mktemp -d)" || exit 1
    trap 'rm -rf "$folder"' EXIT
    mkdir -p "$folder/npr-gpu/bin" "$folder/npr-gpu/models"
    for name in "${programs[@]}"; do
        cp "$bin/$name" "$folder/npr-gpu/bin/$name" || exit 1
        if command -v strip >/dev/null 2>&1; then strip "$folder/npr-gpu/bin/$name" || exit 1; fi
    done
    if [ -f "$bin/commit" ]; then cp "$bin/commit" "$folder/npr-gpu/bin/"; fi
    cp "$here/gpu.sh" "$folder/npr-gpu/" || exit 1
    if [ $# -gt 0 ]; then cp "$@" "$folder/npr-gpu/models/" || exit 1; fi
    tar -czf "$file" -C "$folder" npr-gpu || exit 1
    say "$file: $(du -h "$file" | cut -f 1)"
}

case "${1:-}" in
build)
    build
    exit
    ;;
pack)
    if [ $# -lt 2 ]; then fail "pack: into which file?"; fi
    shift
    pack "$@"
    exit
    ;;
-h | --help)
    sed -n '1d; /^set -u$/q; s/^# \{0,1\}//p' "$0"
    exit
    ;;
-*) fail "$1: no such option" ;;
esac

all="${1:-npr-out/gpu}"
if [ $# -gt 0 ]; then shift; fi
models=("$@")
find_programs
if [ ${#models[@]} = 0 ] && [ -d "$here/models" ] && [ -x "$here/bin/npr" ]; then
    for model in "$here"/models/*; do
        case "$model" in *.obj | *.gltf | *.glb) models+=("$model") ;; esac
    done
    export NPR_MODELS="${NPR_MODELS:-$here/models}"
fi
scratch="$(mktemp -d)" || exit 1
trap 'rm -rf "$scratch"' EXIT
# Mesa asks for this folder and complains where there is none.
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-$scratch}"
# No adapter is a failure, not a reason to skip.
export NPR_GPU=required
export RUST_BACKTRACE=1

limited() {
    local seconds=$1
    shift
    if command -v timeout >/dev/null 2>&1; then timeout -k 5 "$seconds" "$@"; else "$@"; fi
}
if ! command -v timeout >/dev/null 2>&1; then say "no command timeout: steps have no limit"; fi

# What is drawn where a picture needs a file: a torus.
torus="$scratch/torus.obj"
awk 'BEGIN {
    m = 256; n = 96; turn = 8 * atan2(1, 1)
    for (i = 0; i < m; i++) for (j = 0; j < n; j++) {
        a = turn * i / m; b = turn * j / n; r = 1 + 0.4 * cos(b)
        printf "v %.6f %.6f %.6f\n", r * cos(a), 0.4 * sin(b), -r * sin(a)
    }
    for (i = 0; i < m; i++) for (j = 0; j < n; j++) {
        k = (i + 1) % m; l = (j + 1) % n
        printf "f %d %d %d %d\n", i * n + j + 1, k * n + j + 1, k * n + l + 1, i * n + l + 1
    }
}' >"$torus"
picture="${models[0]:-$torus}"

# The adapter, by a small picture, whose shaders go into a cache of their own: the first large picture must be cold.
adapter="$(XDG_CACHE_HOME="$scratch/first" MESA_SHADER_CACHE_DIR="$scratch/first" \
    __GL_SHADER_DISK_CACHE_PATH="$scratch/first" \
    limited 60 "$bin/npr" render "$torus" -o "$scratch/small.png" --size 64x36 --backend gpu 2>&1)"
adapter_status=$?
line="$(printf '%s\n' "$adapter" | sed -n 's/.* to render, on //p' | tail -n 1)"
device="$(printf '%s' "${line:-no device}" | sed 's/ (LLVM[^)]*)//; s/, .*//' | tr '[:upper:]' '[:lower:]' |
    tr -cs 'a-z0-9' '-' | sed 's/^-//; s/-$//')"
out="$all/$device"
rm -rf "$out"
mkdir -p "$out" || exit 1
out="$(cd "$out" && pwd)"
export XDG_CACHE_HOME="$scratch/cache" MESA_SHADER_CACHE_DIR="$scratch/cache" __GL_SHADER_DISK_CACHE_PATH="$scratch/cache"
mkdir -p "$scratch/cache"

names=() statuses=() times=()
failed=0
deadline=$((SECONDS + ${NPR_SECONDS:-470}))

note() {
    names+=("$1")
    statuses+=("$2")
    times+=("$3")
    if [ "$2" != passed ]; then failed=$((failed + 1)); fi
    say "$1: $2, $3 s"
}

# step NAME SECONDS COMMAND: runs it with a limit; its output goes to NAME.txt.
step() {
    local name=$1 limit=$2 begin=$SECONDS status=0
    shift 2
    if [ $((deadline - begin)) -lt "$limit" ]; then limit=$((deadline - begin)); fi
    if [ "$limit" -lt 2 ]; then
        note "$name" "not run, no time was left" 0
        return
    fi
    say "$name, at most $limit s: $*"
    { limited "$limit" "$@"; } >"$out/$name.txt" 2>&1 || status=$?
    case $status in
    0) note "$name" passed $((SECONDS - begin)) ;;
    124 | 137) note "$name" "FAILED: longer than $limit s" $((SECONDS - begin)) ;;
    *) note "$name" "FAILED: status $status" $((SECONDS - begin)) ;;
    esac
}

# Information about the machine, as far as there are tools for it.
machine() {
    printf '%s\n' "$adapter"
    uname -srm
    nproc 2>/dev/null
    sed -n 's/^model name.*: //p' /proc/cpuinfo 2>/dev/null | head -n 1
    if command -v nvidia-smi >/dev/null 2>&1; then limited 10 nvidia-smi; fi
    if command -v vulkaninfo >/dev/null 2>&1; then limited 10 vulkaninfo --summary; fi
    return 0
}
machine >"$out/adapter.txt" 2>&1
if [ "$adapter_status" = 0 ] && [ -n "$line" ]; then
    note adapter passed 0
else
    note adapter "FAILED: status $adapter_status" 0
fi

large="${NPR_SIZE:-3840x2160}"
bench=(--size "${NPR_SIZE:-1280x720}")
timing=()
if [ -n "${NPR_FRAMES:-}" ]; then timing+=(--frames "$NPR_FRAMES"); fi
rounds=()
if [ -n "${NPR_ROUNDS:-}" ]; then rounds+=(--rounds "$NPR_ROUNDS"); fi

render() { # NAME
    step "$1" 60 "$bin/npr" render "$picture" -o "$out/$1.png" --size "$large" --backend gpu --plan
}
render render-cold
render render-warm
step render-same 10 cmp "$out/render-cold.png" "$out/render-warm.png"
step check 120 "$bin/npr" check --out "$out/check"
step chart 120 "$bin/npr" chart --quick -o "$out/chart"
for name in frame shadow hatch; do
    step "bench-$name" 60 "$bin/$name" "${bench[@]}" ${timing[@]+"${timing[@]}"} ${rounds[@]+"${rounds[@]}"}
done
if [ -z "${NPR_SIZE:-}" ]; then
    step bench-frame-4k 60 "$bin/frame" --size 3840x2160 ${timing[@]+"${timing[@]}"} ${rounds[@]+"${rounds[@]}"}
fi
step bench-passes 60 "$bin/passes" "${bench[@]}" --frames "${NPR_FRAMES:-8}"
step tests-outline 60 "$bin/outline-tests"
step tests-imagespace 90 "$bin/imagespace-tests"
for model in ${models[@]+"${models[@]}"}; do
    name="check-$(basename "$model" | tr -c 'A-Za-z0-9.\n' '-')"
    step "$name" 60 "$bin/npr" check "$model" --out "$out/$name"
done

# code FILE [LINES]: the end of a file as a block of text.
code() {
    printf '```text\n'
    tail -n "${2:-60}" "$1"
    printf '```\n\n'
}
{
    printf '# %s\n\n' "${line:-no device}"
    printf '%s, %s' "$(date -u +%Y-%m-%dT%H:%MZ)" "$("$bin/npr" --version)"
    if [ -f "$bin/commit" ]; then printf ', commit %s' "$(cat "$bin/commit")"; fi
    printf '. %s of %s steps failed.\n\n| step | status | s |\n| --- | --- | --- |\n' "$failed" "${#names[@]}"
    for i in "${!names[@]}"; do
        printf '| [%s](%s.txt) | %s | %s |\n' "${names[i]}" "${names[i]}" "${statuses[i]}" "${times[i]}"
    done
    printf '\n## Pictures at %s\n\n' "$large"
    for name in render-cold render-warm; do
        sed -n 's/.*\( [0-9]* ms to wait for the device.*\)/\1/p' "$out/$name.txt" 2>/dev/null | sed "s/^ /- $name: /"
    done
    for name in frame frame-4k shadow hatch passes; do
        if [ -f "$out/bench-$name.txt" ]; then
            printf '\n## Bench %s\n\n' "$name"
            code "$out/bench-$name.txt"
        fi
    done
    printf '## Rows of checks that failed\n\n'
    for file in "$out"/check*.txt; do
        printf '%s: %s\n\n' "$(basename "$file" .txt)" "$(tail -n 1 "$file")"
        if grep -q ' FAIL$' "$file"; then
            grep ' FAIL$' "$file" >"$scratch/rows"
            code "$scratch/rows" 200
        fi
    done
    printf '## Tests\n\n'
    for file in "$out"/tests-*.txt; do
        grep -E '^test result|^test .*FAILED' "$file" >"$scratch/rows"
        code "$scratch/rows" 100
    done
    printf '## Pictures left behind\n\n'
    (cd "$out" && find check* chart -name '*.png' 2>/dev/null | sort | sed 's/^/- /')
} >"$out/summary.md"

say "results in $out"
for i in "${!names[@]}"; do printf '  %-28s %s\n' "${names[i]}" "${statuses[i]}"; done
if [ "$failed" -gt 0 ]; then
    say "$failed of ${#names[@]} steps failed"
    exit 1
fi
say "all ${#names[@]} steps passed"
