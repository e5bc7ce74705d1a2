# What the check_ scripts of the boards have in common; they source it, and set `build` (directory of the preset),
# `board` and `gridiron` (the program).
# SPDX-License-Identifier: Apache-2.0

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
    -o -path '*gridiron_firmware*.dir*' -o -path "*/gridiron_${board}_$image.dir/*" \))
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
