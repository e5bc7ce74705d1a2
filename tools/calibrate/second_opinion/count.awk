# Reads the emulator's traces of the frame programs, one after the other, each behind a line FRAME NAME, and prints what
# second_opinion/run promises. Variables: work (folder with units and NAME.units), target, as_header (not empty: yes).
# SPDX-License-Identifier: Apache-2.0
BEGIN {
  # n = 63 + kind, and the marks of program_core.h: hint #n is d503201f + 32 n, slti zero, zero, n 00002013 + n * 2^20.
  for (kind = 0; kind < 65; ++kind) {
    code = target == "riscv64" ? sprintf("%03x02013", 63 + kind) : sprintf("d5032%03x", 2047 + 32 * kind)
    kind_of[code] = kind
  }
  kGet = 42; kPut = 43; kWait = 44; kKinds = kClaim = 61; kCommandEnd = 62; kCopied = 63; kNothing = 64
  while ((getline line < (work "/units")) > 0) {
    split(line, part, " ")
    name[part[1]] = part[2]
    units[part[1]] = part[3]
    operations[part[1]] = part[4]
    is_of_effects[part[1]] = part[5] == "effects"
  }
  while ((getline line < (work "/dense.units")) > 0) {
    split(line, part, " ")
    dense_units[part[1]] = part[2]
  }
  # What the frame with planes stands for, and no other; what the compact one is for; the exact decisions.
  of_planes["hit_setup"] = of_planes["hit_half"] = of_planes["depth_group"] = 1
  of_lattice["lattice_triangle"] = of_lattice["cell_bound_step"] = 1
  of_decisions["exact_sign"] = of_decisions["exact_distance"] = of_decisions["exact_order"] = 1
}

# Is what a frame counted of a kind a part of the table? As in work_table.cpp.
function stands_for(frame, kind) {
  if (frame == "dense") return 0
  if (frame == "exact") return name[kind] in of_decisions
  if (is_of_effects[kind]) return frame == "lamp" || frame == "sun"
  if (frame == "lamp" || frame == "sun") return 0
  return (name[kind] in of_planes) == (frame == "planes") && (name[kind] in of_lattice) == (frame == "compact")
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

/^FRAME/ { frame = $2; frames[++frame_count] = frame; current = kNothing; next }
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
      if (stands_for(frames[i], kind)) count[kind] += counted[frames[i], kind]
    }
  }
  if (as_header != "") { print_header(); exit }
  printf "%-20s %12s %12s %8s\n", "kind", "instructions", "operations", "ratio"
  for (kind = 0; kind < kKinds; ++kind) {
    if (units[kind] == 0) continue
    per_unit = count[kind] / units[kind]
    printf "%-20s %12.1f %12.1f %8.2f\n", name[kind], per_unit, operations[kind], per_unit / operations[kind]
  }
  if (target == "riscv64") print_commands()
}

function print_commands(    i, f) {
  printf "\n%-12s %9s %9s %9s %9s %9s %9s\n", "frame", "commands", "command", "its end", "waits", "idle wait", "claim"
  for (i = 1; i <= frame_count; ++i) {
    f = frames[i]
    if (!marks[f, kClaim]) continue
    printf "%-12s %9d %9.1f %9.1f %9d %9.1f %9.1f\n", f, commands_of(f), command_of(f), end_of(f), marks[f, kWait],
      idle_wait_of(f), claim_of(f)
  }
}

function print_header(    kind, per_unit, f, note) {
  f = "dense"
  print "// What a unit of each kind of work takes in instructions of a " target " core, 4 lanes, and what commands,"
  print "// waits and claims take on the port of platform/sifive_u. Written by tools/calibrate/second_opinion/run from"
  print "// the kernel in an emulator; do not edit: tools/calibrate/README.md. Of the frame `dense`; kinds that it has"
  print "// none of, of the others. Kinds do not tell the steps through the grid that walks of secondary rays take from"
  print "// those of packets: they have one cost, that of packets."
  print "// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0"
  print "#pragma once\n\n#include <gridiron/base/work_counters.h>\n\n#include <array>\n\nnamespace gridiron::sim {\n"
  print "/// A kind of work."
  print "struct InstructionCost {\n  WorkId kind;\n  double instructions;\n};\n"
  print "/// All kinds but commands and waits."
  print "inline constexpr auto kInstructionCosts = std::to_array<InstructionCost>({"
  for (kind = 0; kind < kKinds; ++kind) {
    if (units[kind] == 0 || count[kind] == 0) continue
    # Where triangles are large, or subpackets culled, other groups are tested: more are hit.
    per_unit = count[kind] / units[kind]
    note = ", not in `dense`"
    if (is_of_effects[kind]) note = ", of effects"
    if (name[kind] in of_decisions) note = ", of 64 decisions"
    if (dense_units[kind] > 0) { per_unit = counted[f, kind] / dense_units[kind]; note = "" }
    printf "    {WorkId(%2d), %7.1f},  // %s%s\n", kind, per_unit, name[kind], note
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
