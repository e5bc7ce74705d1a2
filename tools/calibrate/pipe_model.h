// Two in-order pipes: takes the operations that a kernel did, in basic blocks, and says what they cost.
// Source of the rules: the public handbooks of the SPU; the numbers beside each class.
// Memory: owned, grows with a block. Threads: one model per thread, see current(). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace gridiron::calibrate {

/// What an instruction occupies. The order is that of kClassFacts.
enum class OpClass : std::uint8_t {
  kFloat,    ///< single-precision add, subtract, multiply
  kDouble,   ///< any double-precision operation, conversions to and from float included
  kConvert,  ///< 16-bit integer multiply, float to integer and back, interpolation of an estimate
  kFixed,    ///< add, logic, compare, select of 32-bit integers; compare of floats
  kShift,    ///< word rotate and shift, byte operations
  kShuffle,  ///< shuffle, rotate of a quadword, gather of bits, mask formation, estimates
  kLoad,     ///< of 16 aligned bytes
  kStore,    ///< of 16 aligned bytes
  kBranch,   ///< hinted
  kHint,     ///< where a branch will go; only where PipeRules ask for it
  kCount
};
inline constexpr std::size_t kOpClassCount = static_cast<std::size_t>(OpClass::kCount);

struct ClassFacts {
  const char* name;
  std::uint32_t latency_cycles;  ///< from issue to use
  std::uint32_t hold_cycles;     ///< further cycles in which nothing can be issued
  bool odd;                      ///< odd pipe, else even
};

/// Public figures of the SPU's pipelines (Cell Broadband Engine Programming Handbook, appendix on instruction
/// latencies).
inline constexpr std::array<ClassFacts, kOpClassCount> kClassFacts = {{
    {"float", 6, 0, false},    // single-precision float and fma: 6
    {"double", 13, 6, false},  // double precision: 13, of which 6 stall all issue
    {"convert", 7, 0, false},  // integer multiply, convert: 7
    {"fixed", 2, 0, false},    // simple fixed point: 2
    {"shift", 4, 0, false},    // word rotate and shift, byte operations: 4
    {"shuffle", 4, 0, true},   // shuffle, quadword rotate: 4
    {"load", 6, 0, true},      // load and store: 6
    {"store", 6, 0, true},     // nobody waits for it
    {"branch", 1, 0, true},    // hinted: 0 beyond its own slot
    {"hint", 11, 0, true},     // at least 11 cycles before its branch
}};
/// A mispredicted branch costs 18 to 19 cycles.
inline constexpr std::uint32_t kBranchMissCycles = 18;
/// Basic blocks for which a value stays in its register after its last use. A block uses some ten quadwords, there are
/// 128 registers: an assumption.
inline constexpr std::uint32_t kRegisterBlocks = 8;

/// Registers of 16 bytes.
inline constexpr std::uint32_t kRegisters = 128;

/// Basic blocks that a compiler schedules as one where the branches between them go their usual way: what unrolling a
/// loop four times and moving operations above branches gives. An assumption, compared with the published rate of dual
/// issue, see README.md.
inline constexpr std::uint32_t kSuperblockBranches = 4;

/// What the model assumes of the compiler and of the core. The defaults are charged; others show what they would
/// change.
struct PipeRules {
  std::uint32_t superblock_branches = kSuperblockBranches;
  bool has_hints = false;   ///< a branch that is usually taken needs a hint before it
  bool fuses = false;       ///< a product that is only added to another number costs nothing: fused multiply-add
  bool has_spills = false;  ///< values beyond the registers are stored and loaded again
};

/// What all units of one kind of work came to.
struct KindTotals {
  std::uint64_t units = 0;
  std::uint64_t half_cycles = 0;  ///< twice the cycles of the schedule, branch misses not included
  std::uint64_t pairs = 0;        ///< cycles in which an even and an odd operation issued together, twice
  std::uint64_t misses = 0;       ///< branches that went the rarer way
  std::array<std::uint64_t, kOpClassCount> operations{};

  [[nodiscard]] std::uint64_t even() const;
  [[nodiscard]] std::uint64_t odd() const;
  [[nodiscard]] double cycles() const;  ///< of all units, branch misses included
  /// Lower bound: the fuller pipe never idle, misses included.
  [[nodiscard]] double resource_cycles() const;
  /// Upper bound: the same schedule, nothing issued together.
  [[nodiscard]] double single_issue_cycles() const;
};
/// Adds what other units of the same kind came to.
void add(KindTotals& sum, const KindTotals& more);
using Totals = std::array<KindTotals, kWorkKindCount>;

/// A value that an operation made; 0: a constant, always there.
using Node = std::uint32_t;

/// Where a branch stands: file number * 65536 + line.
using Site = std::uint32_t;

/// How often a branch was not taken, and taken.
using BranchWays = std::array<std::uint64_t, 2>;
using Branches = std::unordered_map<Site, BranchWays>;
/// Adds what the branches did in another run.
void add(Branches& sum, const Branches& more);

/// Superblocks by how many registers their values take at once.
using Pressure = std::array<std::uint64_t, 512>;

/// What a run came to.
struct Counts {
  Totals totals{};
  Pressure pressure{};  ///< where the rules have spills
};

/// Schedules superblocks as a compiler would, longest chain first, and keeps what they cost by kind of work.
///
/// Ties are broken by how values came about, so that the order in which a compiler evaluates operands changes nothing.
class PipeModel {
 public:
  /// @param branches  of earlier runs of the same program: what is usual. Where one of them did not occur, it is
  /// usually
  ///                  not taken. Null: nothing is scheduled, branches are counted.
  explicit PipeModel(const Branches* branches, const PipeRules& rules = {});
  ~PipeModel();
  PipeModel(const PipeModel&) = delete;
  PipeModel& operator=(const PipeModel&) = delete;

  /// The one that counted values report to; set by the constructor, for the calling thread.
  [[nodiscard]] static PipeModel& current();

  /// What follows belongs to `kind`.
  void charge_to(WorkId kind) { kind_ = kind; }
  void add_units(WorkId kind, std::uint32_t amount);

  /// One operation. @param tie  bits of the result.
  Node emit(OpClass op, std::uint64_t tie, Node a = 0, Node b = 0, Node c = 0);
  /// A float product, which may become part of a sum.
  Node emit_product(std::uint64_t tie, Node a, Node b);
  /// A branch that ends the block, on `condition` and on what use_condition() joined.
  void branch(Site site, bool taken, Node condition);
  /// The next condition that is used as a bool is that of the loop at `site`; 0: of none. @param turns  of a loop that
  /// is unrolled where its condition is constant: a branch each 16 of them, else nothing. Null: of another one.
  void expect_loop(Site site, std::uint32_t* turns = nullptr) {
    loop_ = site;
    turns_ = turns;
  }
  /// A condition is used as a bool: that of a loop is a branch; else it is joined to others, or selects, which is one
  /// operation.
  void use_condition(bool value, Node node);
  /// `node` is part of the address of the loads that follow.
  void note_address(Node node);

  // Values in memory, by quadword; stack addresses are registers until they are stored to as vectors.
  void set_stack(const void* base) { stack_base_ = reinterpret_cast<std::uintptr_t>(base); }
  /// The local store. Scalars that lie neither there nor on the stack are constants.
  void set_store(const void* store, std::size_t bytes) {
    store_base_ = reinterpret_cast<std::uintptr_t>(store);
    store_bytes_ = bytes;
  }
  [[nodiscard]] bool is_constant(const void* pointer) const {
    const auto address = reinterpret_cast<std::uintptr_t>(pointer);
    return !on_stack(address) && address - store_base_ >= store_bytes_;
  }
  [[nodiscard]] Node scalar_at(const void* address, std::uint64_t tie);
  void set_scalar(const void* address, Node node, std::uint64_t tie);
  void make_register(const void* address, Node node);
  [[nodiscard]] Node splat_of(const void* address, std::uint64_t tie);
  [[nodiscard]] Node load_quad(const void* address, std::uint64_t tie);
  void store_quad(const void* address, Node node, std::uint64_t tie);
  /// The bytes changed behind the core's back.
  void forget(const void* address, std::size_t bytes);

  [[nodiscard]] const Branches& branches() const { return branches_; }

  /// Ends the last block. @returns what it came to, branch misses included.
  [[nodiscard]] Counts finish();

 private:
  struct Op {
    OpClass op;
    WorkId kind;
    std::uint32_t segment;  // branches before it in the block
    Node deps[3];
    std::uint64_t tie;
    bool is_product;
  };
  struct Quad {
    Node node;
    Node lanes[4];
    std::uint32_t last_block;
  };
  struct Slot {
    Node node;
    bool in_memory;
  };
  [[nodiscard]] bool is_usually_taken(Site site) const;
  [[nodiscard]] bool on_stack(std::uintptr_t address) const { return stack_base_ - address < kStackBytes; }
  [[nodiscard]] Slot& slot_of(std::uintptr_t address) { return slots_[(address >> 2) % slots_.size()]; }
  [[nodiscard]] Quad& quad_at(std::uintptr_t address);
  [[nodiscard]] std::uint64_t ready_of(Node node) const;
  [[nodiscard]] std::array<Node, 2> gather_addresses();
  void schedule();
  /// Makes products that only one sum needs a part of it. @returns by operation, whether it is one.
  [[nodiscard]] std::vector<bool> fuse_products();
  /// How many registers the superblock needs at once: for values that it makes, by the turns in which its operations
  /// left, for those that it takes from before, and for quadwords that stay in theirs. @returns those that there are
  /// not.
  [[nodiscard]] std::uint32_t note_pressure(const std::vector<std::uint32_t>& turns);
  /// A branch that goes its rarer way delays what comes next, which is charged for it, unless that has no price.
  void charge_miss();

  static constexpr std::uintptr_t kStackBytes = std::uintptr_t{1} << 20;
  static constexpr std::size_t kRememberedNodes = std::size_t{1} << 20;

  Totals totals_{};
  WorkId kind_ = Work::kWait;  // what is done before the first tile is not charged by the tile
  bool schedules_;
  std::unordered_map<Site, bool> usual_;
  PipeRules rules_;
  std::uint32_t segment_ = 0;
  std::vector<Op> block_;
  Node first_node_ = 1;  // of the block
  std::uint32_t block_number_ = 1;
  std::uint64_t clock_ = 0;                             // of the last issue
  std::vector<std::uint64_t> ready_, history_, depth_;  // by node, of the last kRememberedNodes
  std::vector<Node> conditions_;
  std::optional<WorkId> missed_;    // of a branch that went its rarer way and is not charged yet
  Site loop_ = 0;                   // whose condition is used next
  std::uint32_t* turns_ = nullptr;  // of it
  std::vector<Node> addresses_;
  bool addresses_used_ = false;
  std::uintptr_t stack_base_ = 0, store_base_ = 0;
  std::size_t store_bytes_ = 0;
  std::vector<Slot> slots_;
  std::unordered_map<std::uintptr_t, Quad> quads_;
  Branches branches_;
  Pressure pressure_{};
  PipeModel* outer_;

  // Working space of schedule().
  std::vector<std::uint64_t> height_, earliest_;
  std::vector<std::uint32_t> missing_, candidates_, first_successor_, successors_, left_in_segment_;
};

}  // namespace gridiron::calibrate
