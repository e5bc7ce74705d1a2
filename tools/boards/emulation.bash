# What the run_ scripts of the boards have in common; they source it. They set `limit` (seconds), and in `given` a default
# for each option of their own; read_request fills in the rest.
# SPDX-License-Identifier: Apache-2.0

me=$(basename "$0")
board=${me#run_}
job='' words=arg=gridiron  # words: for the firmware
declare -A given=([-o]='' [--image]='' [--build]=$root/build/$board [--limit]='')

# The script's own opening comment.
usage() {
  sed -n 's/^#   //p' "$0" >&2
  exit 125
}
fail() {
  echo "$me: $*" >&2
  exit 125
}

# read_request QEMU DEBIAN_PACKAGE ARGUMENTS...: reads the command line and checks that what it names is there.
read_request() {
  local qemu=$1 package=$2
  shift 2
  while [ $# -gt 0 ]; do
    case "$1" in
      --option) [ $# -ge 2 ] || usage; words+=",arg=$2"; shift 2 ;;
      -*) [ $# -ge 2 ] && [ -v "given[$1]" ] || usage; given[$1]=$2; shift 2 ;;
      *) [ -z "$job" ] || usage; job=$1; shift ;;
    esac
  done
  result=${given[-o]} image=${given[--image]} build=${given[--build]} limit=${given[--limit]:-$limit}
  [ -n "$job" ] && [ -n "$result" ] || usage
  [ -f "$job" ] || fail "$job: no such job"
  [ "$(stat -c %s "$job")" -ge 256 ] || fail "$job: ends inside of its first record"
  [ -d "$(dirname -- "$result")" ] && [ ! -d "$result" ] || fail "$result: no place for a file"
  [ ! "$job" -ef "$result" ] || fail "$job: the result would take its place"
  command -v "$qemu" > /dev/null || fail "no $qemu (Debian package $package)"
}

# word_of_job OFFSET BYTES: a number of the job's file.
word_of_job() { od -A n -t "u$2" -j "$1" -N "$2" "$job" | tr -d ' '; }

# plain, or effects where the job calls for them; with _tree where eye rays go through the tree.
image_for_job() {
  local effects image=plain base frame engine=
  effects=$(word_of_job 140 4)  # FrameJob::effects, base_address, frame_address; FrameHead::engine_id
  base=$(word_of_job 8 8)
  frame=$(word_of_job 32 8)
  if [ "${effects:-0}" != 0 ]; then image=effects; fi
  if ((frame >= base && frame - base <= $(stat -c %s "$job"))); then engine=$(word_of_job $((frame - base + 36)) 4); fi
  if [ "${engine:-1}" = 2 ]; then image+=_tree; fi
  echo $image
}

# emulate ADDRESS HARMLESS QEMU ARGUMENTS...: runs the image with the job at ADDRESS, moves the result to its place and
# exits with the device's code, 124 after the limit, 125 where the emulator's log (-d says of what) has anything but
# HARMLESS lines, a regular expression.
emulate() {
  local address=$1 harmless=$2 elf=$build/bin/${board}_$image.elf status=0
  shift 2
  [ -f "$elf" ] || fail "$elf is not built: cmake --preset $board && cmake --build --preset $board"

  # The device writes result.bin into the emulator's directory. Names of files are the host's own, without commas there.
  work=$(mktemp -d)
  emulator=
  trap 'kill $emulator 2> /dev/null || true; rm -rf "$work"' EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM HUP
  rm -f -- "$result" "$result".[0-9]
  ln -s "$(realpath "$job")" "$work/job.bin"
  ln -s "$(realpath "$elf")" "$work/firmware.elf"
  (
    cd "$work"
    exec timeout --kill-after=5 "$limit" "$@" -kernel firmware.elf \
      -device "loader,file=job.bin,addr=$address,force-raw=on" -semihosting-config "enable=on,target=native,$words" \
      -display none -serial stdio -monitor none -D emulator.log < /dev/null 2> words.log
  ) &
  emulator=$!
  wait $emulator || status=$?
  emulator=
  grep -v 'audiodev default parameter is deprecated' "$work/words.log" >&2 || true

  [ $status -ne 1 ] || fail 'the emulator did not run'
  [ -f "$work/emulator.log" ] || fail 'the emulator has left no log'
  local lines=0
  grep -v "$harmless" "$work/emulator.log" > "$work/errors" || lines=$?
  if [ $lines -ne 1 ]; then  # 1: none, and the log was read
    echo "$me: the emulator saw what no device or memory answers:" >&2
    head -n 5 "$work/errors" >&2
    exit 125
  fi
  if [ -f "$work/result.bin" ]; then mv -- "$work/result.bin" "$result"; fi
  local each number
  for each in "$work"/result_*.bin; do  # of several frames
    number=${each##*_}
    if [ -f "$each" ]; then mv -- "$each" "$result.${number%.bin}"; fi
  done
  [ $status -ne 124 ] || echo "$me: stopped after $limit s" >&2
  exit $status
}
