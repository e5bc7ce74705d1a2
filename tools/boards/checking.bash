# What the check_ scripts of the boards have in common; they source it, and set `board`, and before other functions than
# begin_check `build` (directory of the preset) and `gridiron` (the program).
# SPDX-License-Identifier: Apache-2.0

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
checks=$(cd "$(dirname "${BASH_SOURCE[0]}")/../checks" && pwd)

# hold_stack LOG IMAGE ENTRY [--leaf SYMBOL]...: of a run of IMAGE whose words are in LOG, the painted stack of each
# core is within what the call graph of the image says from the workers' ENTRY on, and that within the board's budget.
# Else its words say so, and it ends with 1. --leaf: a function in assembly that needs next to none.
hold_stack() {
  local log=$1 image=$2 entry=$3 painted budget bound graphs
  shift 3
  read -r painted budget < <(awk '/^core [0-9]+: status .* stack [0-9]+ of [0-9]+$/ {
      if ($(NF - 2) > painted) painted = $(NF - 2)
      budget = $NF
    }
    END { print painted + 0, budget + 0 }' "$log")
  mapfile -t graphs < <(find "$build" -name '*.ci' \( -path '*gridiron_kernel.dir*' \
    -o -path '*gridiron_prepare.dir*' -o -path '*gridiron_firmware*.dir*' -o -path "*/gridiron_${board}_$image.dir/*" \
    -o -path "*/gridiron_${board}_kernel_$image.dir/*" -o -path "*/gridiron_${board}_port_$image.dir/*" \))
  bound=$("$checks/deepest_stack" --from "$entry" "$@" "${graphs[@]}") || bound=''
  if [ "$painted" -gt 0 ] && [ "$painted" -le "${bound:-0}" ] && [ "$bound" -le "$budget" ]; then
    echo "ok  stack, $image: $painted bytes painted, at most $bound by the call graph, $budget in the budget"
  else
    echo "stack, $image: $painted bytes painted, at most ${bound:-unknown} by the call graph, $budget in the budget" >&2
    return 1
  fi
}

# compare_result JOB RESULT LOG EXIT_CODE: of `gridiron`, which with 0 finds planes, work and transfers equal to the
# simulated chip's, with 3 not. Transfers count in no comparison where the firmware has counted none: that is refused.
# Words in LOG; ends with 1 where it is otherwise.
compare_result() {
  local job=$1 result=$2 log=$3 wanted=$4 status=0
  "$gridiron" result "$job" "$result" --compare > "$log" 2>&1 || status=$?
  if [ $status -ne "$wanted" ]; then
    echo "the comparison ends with $status, not $wanted" >> "$log"
    return 1
  fi
  if [ $status -eq 0 ] && ! grep -q '^tiles.transfers *equal' "$log"; then
    echo 'transfers were not counted' >> "$log"
    return 1
  fi
}

# wait_for_core: until fewer jobs of this shell run than the host has cores.
wait_for_core() {
  while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n || true; done
}

# bytes_of WORD COUNT: a number as little-endian bytes, for printf.
bytes_of() {
  local word=$1 bytes='' byte i
  for ((i = 0; i < $2; ++i)); do
    printf -v byte '\\x%02x' $((word >> 8 * i & 255))
    bytes+=$byte
  done
  echo "$bytes"
}

# change FILE OFFSET BYTES WORD: WORD takes the place of so many BYTES.
change() {
  # shellcheck disable=SC2059
  printf "$(bytes_of "$4" "$3")" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

# read_word FILE OFFSET: 8 bytes.
read_word() { od -A n -t d8 -j "$2" -N 8 "$1" | tr -d ' '; }

# seal JOB: gives it the check value of its bytes (core/gridiron/base/check_value.h; FrameJob::check_value), as whoever
# makes a wrong job on purpose. For small jobs: a second for each 2 MB.
seal() {
  local -i prime=0x100000001b3 basis=0xcbf29ce484222325 i=0
  local -ai words sums=(basis basis basis basis basis basis basis basis)
  change "$1" 152 8 0
  mapfile -t words < <(od -A n -v -w8 -t d8 "$1")
  for ((i = 0; i < ${#words[@]}; ++i)); do sums[i & 7]=$(((sums[i & 7] ^ words[i]) * prime)); done
  for ((i = 0; i < 8; ++i)); do basis=$(((basis ^ sums[i]) * prime)); done
  change "$1" 152 8 $basis
}

# break_record JOB FIELD: the frame record says what job and image do not, and the check value is that of the bytes.
# FIELD: colour, width, triangles. Prints how the refusal begins.
break_record() {
  local frame
  frame=$(($(read_word "$1" 32) - $(read_word "$1" 8)))   # FrameJob::frame_address, base_address
  case "$2" in
    colour) change "$1" $((frame + 112)) 8 $((0x200000)); echo 'frame record: color_address' ;;
    width) change "$1" $((frame + 8)) 4 2048; echo 'frame record: width' ;;
    triangles) change "$1" $((frame + 336)) 8 0; echo 'frame record: triangles_address' ;;
  esac
  seal "$1"
}

# moving_series RUN IMAGE JOB OPTIONS...: jobs of eight frames of the mesh that moves, made with JOB's words, and their
# results, which `RUN FRAME-0-JOB --image IMAGE --option first=0 --option frames=8` leaves as $work/result.0 and so on:
# each is what the simulated chip makes of the host's image, and not of the next frame's. Words in $work/log; ends with 1
# where it is otherwise.
moving_series() {
  local run=$1 image=$2 frame
  shift 2
  for frame in 0 1 2 3 4 5 6 7; do
    [ -f "$work/moving.$frame.job" ] && continue
    "$(dirname "$gridiron")/make_mesh" --shape wave --frame $frame -o "$work/moving.ply" > "$work/log" &&
      "$gridiron" job "$work/moving.ply" --configuration best --base 0x81000000 --memory 117440512 --size 96x96 --depth \
        --ids --eye 1.5,2,3 --at 0,0.2,0 --quiet -o "$work/moving.$frame.job" "$@" > "$work/log" 2>&1 || return 1
  done
  "$run" "$work/moving.0.job" --image "$image" --option first=0 --option frames=8 || return 1
  for frame in 0 1 2 3 4 5 6 7; do
    compare_result "$work/moving.$frame.job" "$work/result.$frame" "$work/log" 0 || return 1
  done
  compare_result "$work/moving.3.job" "$work/result.4" "$work/log" 3
}

# A check of one frame after the other, of check_virt and check_zcu102. They set `base`, `memory` and `cores` of the jobs.
# The words of each run are in NAME.log.

# begin_check [GRIDIRON] [BUILD]: with GRIDIRON_SCENES the scene is the bunny there, else the teapot.
begin_check() {
  if [[ ${1:-} == -* ]]; then
    sed -n 's/^#   //p' "$0" >&2
    exit 2
  fi
  gridiron=${1:-$root/build/host/bin/gridiron} build=${2:-$root/build/$board}
  scene=$root/scenes/teapot.ply view=()
  if [ -f "${GRIDIRON_SCENES:-}/bunny.ply" ]; then
    scene=$GRIDIRON_SCENES/bunny.ply view=(--camera "$root/scenes/bunny.camera")
  fi
}

# fail NAME WORDS...
fail() {
  cat "$work/$1.log" >&2
  shift
  echo "check_$board: $*" >&2
  exit 1
}

# job NAME INPUT OPTIONS...
job() {
  local name=$1 input=$2
  shift 2
  "$gridiron" job "$input" --base "$base" --memory "$memory" --cores "$cores" --quiet -o "$work/$name.job" "$@" \
    > "$work/$name.log" 2>&1 || fail "$name" "no job $name"
}

# run NAME EXIT_CODES OPTIONS...: its result in NAME.result, its exit code in `status`; EXIT_CODES as 0|6.
run() {
  local name=$1 wanted=$2
  status=0
  shift 2
  "$root/tools/boards/run_$board" "$work/$name.job" -o "$work/$name.result" --build "$build" "$@" \
    > "$work/$name.log" 2>&1 || status=$?
  [[ $status =~ ^($wanted)$ ]] || fail "$name" "$name $*: exit code $status, not $wanted"
}

# compare NAME EXIT_CODE
compare() {
  compare_result "$work/$1.job" "$work/$1.result" "$work/$1.log" "$2" || fail "$1" "$1: not as the simulated chip's"
}

# said NAME WORDS WHAT: a line of the log begins with WORDS, a regular expression; else WHAT is wrong.
said() { grep -q "^$2" "$work/$1.log" || fail "$1" "$3"; }

# trespass NUMBER EXIT_CODE WORDS: the firmware does what a core must not do, and says WORDS.
trespass() {
  run standard "$2" --image trespass --option "trespass=$1"
  said standard "$3" "trespass $1: another report"
}

# refuse_job NAME WORDS: broken.job is refused, for a reason that begins with WORDS.
refuse_job() {
  run broken 2
  said broken "job refused: $2" "$1: another reason"
}

# refuse_broken_jobs WIDTH: jobs with one byte changed, one for tiles of another width, and `small` with wrong records.
refuse_broken_jobs() {
  local change offset word field
  for change in '0 magic' '11 base address' "$(($(stat -c %s "$work/standard.job") - 1)) check value"; do
    read -r offset word <<< "$change"
    cp "$work/standard.job" "$work/broken.job"
    change "$work/broken.job" "$offset" 1 0xa5
    refuse_job "job with byte $offset changed" "$word"
  done
  job broken "$scene" --configuration reference --store "$1" --size 64x64
  refuse_job 'a job of other tiles' 'tile width'
  for field in colour width triangles; do
    cp "$work/small.job" "$work/broken.job"
    word=$(break_record "$work/broken.job" $field)
    refuse_job "job whose record has another $field" "$word"
  done
  echo 'ok  seven wrong jobs are refused'
}
