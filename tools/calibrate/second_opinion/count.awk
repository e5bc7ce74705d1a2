# Reads the emulator's traces of the frame programs, one after the other, each behind a line FRAME NAME, and prints what
# second_opinion/run promises. Variables: work (the folder of write_memories), target, as_header (not empty: yes).
# SPDX-License-Identifier: Apache-2.0
BEGIN {
  # n = 128 + kind, and the marks of program_core.h: movz xzr, #n is d280001f + 32 n, slti zero, zero, n
  # 00002013 + n * 2^20.
  for (kind = 0; kind < 108; ++kind) {
    code = target == "riscv64" ? sprintf("%03x02013", 128 + kind) : sprintf("d28%05x", 31 + 32 * (128 + kind))
    kind_of[code] = kind
  }
  kKinds = kClaim = 104; kCommandEnd = 105; kCopied = 106; kNothing = 107
  while ((getline line < (work "/units")) > 0) {
    split(line, part, " ")
    name[part[1]] = part[2]
    if (part[5] == "events") { event[part[2]] = part[1]; continue }
    units[part[1]] = part[3]
    operations[part[1]] = part[4]
    is_of_effects[part[1]] = part[5] == "effects"
  }
  kGet = event["get_issue"]; kPut = event["put_issue"]; kWait = event["wait"]
  while ((getline line < (work "/exact.units")) > 0) {
    split(line, part, " ")
    if (part[2] > 0) of_decisions[name[part[1]]] = 1
  }
  # What a frame counted of a kind is a part of the table.
  while ((getline line < (work "/parts")) > 0) {
    split(line, part, " ")
    is_part[part[1], part[2]] = 1
  }
}

function go_to(kind) {
  if (current == kWait && kind != kNothing) {
    ++wait_count[frame, ended]
    wait_sum[frame, ended] += counted[frame, kWait] - wait_begin
    if (ended > most_ended) most_ended = ended
  }
  if (kind == kWait) { wait_begin = counted[frame, kWait]; ended = 0 }
  current = kind
}

# A copy stands within a command or a wait: these go on behind it.
function take_mark(m) {
  if (m == kNothing) { before = current; current = kNothing }
  else if (m == kCopied) current = before
  else if (m == kCommandEnd) ++ended
  else { go_to(m); ++marks[frame, m] }
}

function commands_of(f) { return marks[f, kGet] + marks[f, kPut] }
# Of a wait that ends no command, and what each command that it ends adds.
function idle_wait_of(f) { return wait_count[f, 0] ? wait_sum[f, 0] / wait_count[f, 0] : 0 }
function end_of(f,    n, sum, ends) {
  for (n = 1; n <= most_ended; ++n) {
    sum += wait_sum[f, n] - wait_count[f, n] * idle_wait_of(f)
    ends += n * wait_count[f, n]
  }
  return ends ? sum / ends : 0
}
function command_of(f) { return (counted[f, kGet] + counted[f, kPut]) / commands_of(f) }
function claim_of(f) { return counted[f, kClaim] / marks[f, kClaim] }

/^FRAME/ {
  frame = $2
  frames[++frame_count] = frame
  current = kNothing
  while ((getline line < (work "/" frame ".units")) > 0) {
    split(line, part, " ")
    frame_units[frame, part[1]] = part[2]
  }
  next
}
/^FAILED/ { failed = failed " " $2; next }
/^IN:/ { fresh = 1; next }
/^0x/ {
  address = substr($1, 3)
  sub(/:$/, "", address)
  while (length(address) < 16) address = "0" address
  if (fresh) { block = address; steps[block] = 0; has_marks[block] = 0; fresh = 0 }
  n = steps[block]++
  mark[block, n] = ($2 in kind_of) ? kind_of[$2] : -1
  if (mark[block, n] >= 0) has_marks[block] = 1
  next
}
/^Trace/ {
  split($0, part, "/")
  block = part[2]
  n = steps[block]
  if (!has_marks[block]) { counted[frame, current] += n; next }
  for (i = 0; i < n; ++i) {
    m = mark[block, i]
    if (m >= 0) take_mark(m)
    else ++counted[frame, current]
  }
}

END {
  if (failed != "") {
    print "second_opinion: not rendered:" failed > "/dev/stderr"
    exit 1
  }
  for (kind = 0; kind < kKinds; ++kind) {
    for (i = 1; i <= frame_count; ++i) {
      if ((frames[i], kind) in is_part) count[kind] += counted[frames[i], kind]
    }
  }
  if (as_header != "") print_header()
  table = as_header != "" ? "/dev/stderr" : "/dev/stdout"
  printf "%-20s %12s %12s %8s\n", "kind", "instructions", "operations", "ratio" > table
  for (kind = 0; kind < kKinds; ++kind) {
    if (units[kind] == 0) continue
    per_unit = count[kind] / units[kind]
    printf "%-20s %12.1f %12.1f %8.2f\n", name[kind], per_unit, operations[kind], per_unit / operations[kind] > table
  }
  if (target == "riscv64") print_commands()
}

# Where triangles are large, or subpackets culled, other groups are tested: more are hit.
function price_of(kind) {
  if (frame_units["dense", kind] > 0) return counted["dense", kind] / frame_units["dense", kind]
  return units[kind] ? count[kind] / units[kind] : 0
}

function print_commands(    i, f, kind, work_sum, priced) {
  printf "\n%-12s %9s %9s %9s %9s %9s %9s %9s %9s\n", "frame", "work, M", "priced", "commands", "command", "its end", \
    "waits", "idle wait", "claim" > table
  for (i = 1; i <= frame_count; ++i) {
    f = frames[i]
    if (!marks[f, kClaim]) continue
    work_sum = priced = 0
    for (kind = 0; kind < kKinds; ++kind) {
      if (kind == kGet || kind == kPut || kind == kWait) continue
      work_sum += counted[f, kind]
      priced += price_of(kind) * frame_units[f, kind]
    }
    printf "%-12s %9.2f %+8.1f%% %9d %9.1f %9.1f %9d %9.1f %9.1f\n", f, work_sum / 1e6,
      100 * (priced / work_sum - 1), commands_of(f), command_of(f), end_of(f), marks[f, kWait],
      idle_wait_of(f), claim_of(f) > table
  }
}

function print_header(    kind, f, note) {
  f = "dense"
  print "// What a unit of each kind of work takes in instructions of a " target " core, 4 lanes, and what commands,"
  print "// waits and claims take on the port of platform/sifive_u. Written by tools/calibrate/second_opinion/run from"
  print "// the kernel in an emulator; do not edit: tools/calibrate/README.md. Of the frame `dense`; kinds that it has"
  print "// none of, of the others."
  print "// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0"
  print "#pragma once\n\n#include <gridiron/base/work_counters.h>\n\n#include <array>\n\nnamespace gridiron::sim {\n"
  print "/// A kind of work."
  print "struct InstructionCost {\n  WorkId kind;\n  double instructions;\n};\n"
  print "/// All kinds but commands and waits."
  print "inline constexpr auto kInstructionCosts = std::to_array<InstructionCost>({"
  for (kind = 0; kind < kKinds; ++kind) {
    if (units[kind] == 0 || count[kind] == 0) continue
    note = ", not in `dense`"
    if (is_of_effects[kind]) note = ", of effects"
    if (name[kind] in of_decisions) note = ", of 64 decisions"
    if (frame_units["dense", kind] > 0) note = ""
    printf "    {WorkId(%2d), %7.1f},  // %s%s\n", kind, price_of(kind), name[kind], note
  }
  print "});\n"
  print "/// A command: from where core counts it to the next kind of work, and its end in a wait."
  printf "inline constexpr double kCommandInstructions = %.1f;\n", command_of(f) + end_of(f)
  print "/// A wait: from where core counts it to the next kind of work, without the ends of commands."
  printf "inline constexpr double kWaitInstructions = %.1f;\n", idle_wait_of(f)
  print "/// A claim: from asking for a tile to the tile's first work."
  printf "inline constexpr double kClaimInstructions = %.1f;\n", claim_of(f)
  print "\n}  // namespace gridiron::sim"
}
