// Ranks by MPI. SPDX-License-Identifier: Apache-2.0
#include "mpi_ranks.h"

#include <sched.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/content_hash.h"
#include "base/patience.h"
#include "base/stopwatch.h"
#include "base/value_bytes.h"
#include "base/words.h"
#include "files/input_file.h"
#include "files/interrupt.h"

namespace gridiron::tool {
namespace {

enum Tag : int { kHeadTag = 1, kPieceTag = 2, kFailureTag = 3 };

constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 30;
constexpr std::size_t kSharedPieceBytes = std::size_t{64} << 20;

// Errors of MPI end the program by themselves unless they are returned.
void check(int result, const char* doing) {
  if (result == MPI_SUCCESS) return;
  char words[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  (void)MPI_Error_string(result, words, &length);
  throw Failure(ExitCode::kBadInput, std::string("MPI cannot ") + doing + ": " + words);
}

std::string name_of_node() {
  char name[MPI_MAX_PROCESSOR_NAME] = "";
  int length = 0;
  (void)MPI_Get_processor_name(name, &length);
  return name;
}

std::string words_of_rank(std::uint32_t rank, const std::string& node) {
  return "rank " + std::to_string(rank) + " on " + node;
}

std::uint64_t hash_of_program() {
  const InputFile file = read_input_file("/proc/self/exe", "expected this program");
  return content_hash(file.bytes);
}

// Processors that the launcher has given to this process, divided by the processes of the node that have the same.
std::uint32_t threads_of(MPI_Comm node, int ranks_on_node) {
  cpu_set_t own;
  CPU_ZERO(&own);
  if (::sched_getaffinity(0, sizeof own, &own) != 0) return 1;
  std::vector<cpu_set_t> all(static_cast<std::size_t>(ranks_on_node));
  check(MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, node), "compare processors");
  const auto alike = std::ranges::count_if(all, [&own](const cpu_set_t& set) { return CPU_EQUAL(&set, &own) != 0; });
  return static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(1, CPU_COUNT(&own) / std::max<std::ptrdiff_t>(1, alike)));
}

// A page that the file system of shared memory does not have ends the process by SIGBUS.
void require_shared_memory(std::uint64_t bytes, const char* what) {
  struct statvfs state {};
  if (::statvfs("/dev/shm", &state) != 0) return;  // MPI takes another one
  const std::uint64_t free_bytes = std::uint64_t{state.f_bavail} * state.f_frsize;
  if (free_bytes >= bytes) return;
  throw Failure(ExitCode::kBadInput, std::string(what) + " would take " + words_of_bytes(bytes) +
                                         " of memory that the ranks of " + name_of_node() + " share; /dev/shm has " +
                                         words_of_bytes(free_bytes) + " left");
}

}  // namespace

bool MpiRanks::Transfer::is_done() {
  int done = 0;
  check(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE), "move a message");
  return done != 0;
}

MpiRanks::MpiRanks() {
  int provided = 0;
  check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided), "begin");
  check(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN), "set how errors are reported");
  int rank = 0, count = 1;
  check(MPI_Comm_rank(MPI_COMM_WORLD, &rank), "tell the rank");
  check(MPI_Comm_size(MPI_COMM_WORLD, &count), "count ranks");
  check(MPI_Comm_dup(MPI_COMM_WORLD, &messages_), "copy its communicator");
  check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &node_), "find ranks of a node");
  check(MPI_Comm_size(node_, &on_node_), "count ranks of a node");
  check(MPI_Comm_rank(node_, &rank_on_node_), "tell the rank on a node");
  check(MPI_Comm_split(MPI_COMM_WORLD, rank_on_node_ == 0 ? 0 : MPI_UNDEFINED, rank, &leaders_), "find the nodes");
  threads_ = threads_of(node_, on_node_);
  rank_ = static_cast<std::uint32_t>(rank);
  count_ = static_cast<std::uint32_t>(count);
  if (provided < MPI_THREAD_SERIALIZED) {
    throw Failure(ExitCode::kBadInput, "this MPI was built without threads (MPI_THREAD_SERIALIZED)");
  }
}

MpiRanks::~MpiRanks() = default;  // finish() or abort() ends MPI

std::string MpiRanks::name() const {
  return words_of_rank(rank_, name_of_node());
}

void MpiRanks::start_pieces(Transfer& transfer, int tag, bool is_send) {
  const int peer = static_cast<int>(transfer.rank);
  for (std::uint64_t begin = 0; begin < transfer.byte_count; begin += kPieceBytes) {
    const int count = static_cast<int>(std::min(kPieceBytes, transfer.byte_count - begin));
    std::byte* const bytes = transfer.bytes.data() + begin;
    MPI_Request& request = transfer.requests.emplace_back(MPI_REQUEST_NULL);
    check(is_send ? MPI_Isend(bytes, count, MPI_BYTE, peer, tag, messages_, &request)
                  : MPI_Irecv(bytes, count, MPI_BYTE, peer, tag, messages_, &request),
          is_send ? "send a message" : "receive a message");
  }
}

void MpiRanks::send(std::uint32_t rank, Bytes message) {
  flush();
  told_ = std::make_unique<Transfer>();
  told_->rank = rank;
  told_->byte_count = message.size();
  told_->bytes = std::move(message);
  MPI_Request& head = told_->requests.emplace_back(MPI_REQUEST_NULL);
  check(MPI_Isend(&told_->byte_count, 1, MPI_UINT64_T, static_cast<int>(rank), kHeadTag, messages_, &head),
        "send a message");
  start_pieces(*told_, kPieceTag, /*is_send=*/true);
}

void MpiRanks::tell_first(Bytes message) {
  send(0, std::move(message));
}

void MpiRanks::tell(std::uint32_t rank, Bytes message) {
  send(rank, std::move(message));
  flush();
}

Bytes MpiRanks::hear() {
  Patience patience;
  while (true) {
    look_for_message();
    if (!arriving_.empty() && arriving_.front()->is_done()) break;
    attend();
    patience.pause();
  }
  Bytes message = std::move(arriving_.front()->bytes);
  arriving_.pop_front();
  return message;
}

bool MpiRanks::has_told() {
  if (told_ && told_->is_done()) told_.reset();
  return told_ == nullptr;
}

void MpiRanks::flush() {
  Patience patience;
  while (!has_told()) {
    attend();
    patience.pause();
  }
}

void MpiRanks::look_for_failure() {
  if (!is_first()) return;
  int has = 0;
  MPI_Status status;
  check(MPI_Iprobe(MPI_ANY_SOURCE, kFailureTag, messages_, &has, &status), "look for messages");
  if (has == 0) return;
  int count = 0;
  check(MPI_Get_count(&status, MPI_BYTE, &count), "measure a message");
  Bytes bytes(static_cast<std::size_t>(count));
  check(MPI_Recv(bytes.data(), count, MPI_BYTE, status.MPI_SOURCE, kFailureTag, messages_, MPI_STATUS_IGNORE),
        "receive a message");
  ByteReader reader(bytes);
  const auto code = reader.take<ExitCode>();
  std::string message;
  reader.take(message);
  throw Failure(code, message);
}

void MpiRanks::look_for_message() {
  int has = 0;
  MPI_Status status;
  check(MPI_Iprobe(MPI_ANY_SOURCE, kHeadTag, messages_, &has, &status), "look for messages");
  if (has == 0) return;
  auto transfer = std::make_unique<Transfer>();
  transfer->rank = static_cast<std::uint32_t>(status.MPI_SOURCE);
  check(MPI_Recv(&transfer->byte_count, 1, MPI_UINT64_T, status.MPI_SOURCE, kHeadTag, messages_, MPI_STATUS_IGNORE),
        "receive a message");
  transfer->bytes.resize(static_cast<std::size_t>(transfer->byte_count));
  start_pieces(*transfer, kPieceTag, /*is_send=*/false);
  arriving_.push_back(std::move(transfer));
}

void MpiRanks::attend() {
  if (!is_finishing_) stop_if_interrupted();
  if (!is_first()) {
    (void)has_told();
    return;
  }
  look_for_failure();
  look_for_message();
}

std::optional<RankMessage> MpiRanks::poll() {
  if (!is_first()) return std::nullopt;
  look_for_message();
  std::vector<bool> is_waited_for(count_);  // ranks of which an earlier message is still under way
  for (auto transfer = arriving_.begin(); transfer != arriving_.end(); ++transfer) {
    const std::uint32_t from = (*transfer)->rank;
    if (is_waited_for[from] || !(*transfer)->is_done()) {
      is_waited_for[from] = true;
      continue;
    }
    RankMessage message{(*transfer)->rank, std::move((*transfer)->bytes)};
    arriving_.erase(transfer);
    return message;
  }
  return std::nullopt;
}

void MpiRanks::wait_for(MPI_Request& request) {
  Patience patience;
  int done = 0;
  while (true) {
    check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "move a message");
    if (done != 0) return;
    attend();
    patience.pause();
  }
}

void MpiRanks::broadcast(Bytes& bytes) {
  flush();
  std::uint64_t byte_count = bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ibcast(&byte_count, 1, MPI_UINT64_T, 0, messages_, &request), "broadcast");
  wait_for(request);
  bytes.resize(static_cast<std::size_t>(byte_count));
  broadcast_pieces(bytes, messages_);
}

void MpiRanks::broadcast_pieces(std::span<std::byte> bytes, MPI_Comm among) {
  for (std::size_t begin = 0; begin < bytes.size(); begin += kPieceBytes) {
    const auto count = static_cast<int>(std::min<std::uint64_t>(kPieceBytes, bytes.size() - begin));
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Ibcast(bytes.data() + begin, count, MPI_BYTE, 0, among, &request), "broadcast");
    wait_for(request);
  }
}

void MpiRanks::meet_on_node() {
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ibarrier(node_, &request), "wait for the ranks of a node");
  wait_for(request);
}

void MpiRanks::share_bytes(std::span<std::byte> bytes, const char* what,
                           const std::function<void(std::uint64_t begin, std::span<std::byte> shared)>& place) {
  flush();
  const bool is_leader = rank_on_node_ == 0;
  if (on_node_ == 1) {
    broadcast_pieces(bytes, leaders_);
    return;
  }
  if (is_leader) require_shared_memory(bytes.size(), what);
  meet_on_node();
  // The leader has all pages of the window, and one more, so that the bytes begin on a page as `bytes` may.
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  MPI_Win window = MPI_WIN_NULL;
  void* memory = nullptr;
  check(MPI_Win_allocate_shared(is_leader ? static_cast<MPI_Aint>(bytes.size() + 2 * page) : 0, 1, MPI_INFO_NULL, node_,
                                &memory, &window),
        "take memory that a node shares");
  MPI_Aint window_bytes = 0;
  int unit = 1;
  check(MPI_Win_shared_query(window, 0, &window_bytes, &unit, &memory), "find the memory that a node shares");
  const auto place_in_page = reinterpret_cast<std::uintptr_t>(bytes.data()) % page;
  const auto first_page = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const std::span<std::byte> shared(reinterpret_cast<std::byte*>(first_page + place_in_page), bytes.size());
  // A piece of whole pages at a time: rank 0 gives its own pages back as it goes.
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.size(), begin + kSharedPieceBytes - (begin == 0 ? place_in_page : 0));
    const std::span<std::byte> piece = shared.subspan(begin, end - begin);
    if (is_first()) std::memcpy(piece.data(), bytes.data() + begin, piece.size());
    if (is_leader) broadcast_pieces(piece, leaders_);
    meet_on_node();
    place(begin, piece);
    begin = end;
  }
  meet_on_node();
  check(MPI_Win_free(&window), "free memory that a node shares");
}

void MpiRanks::require_alike(const std::string& version, const std::string& arguments) {
  ByteWriter writer;
  for (const std::string& text : {name_of_node(), version}) writer.add(text);
  writer.add(hash_of_program());
  writer.add(arguments);
  const std::vector<Bytes> all = exchange(writer.take());
  if (!is_first()) return;
  const std::uint64_t program = hash_of_program();
  for (std::uint32_t i = 1; i < count_; ++i) {
    ByteReader reader(all[i]);
    std::string node, its_version, its_arguments;
    reader.take(node);
    reader.take(its_version);
    const auto its_program = reader.take<std::uint64_t>();
    reader.take(its_arguments);
    const std::string name = words_of_rank(i, node);
    if (its_version != version) {
      throw Failure(ExitCode::kUsage, name + " runs version " + its_version + " of this program, " + this->name() +
                                          " version " + version + "; all must run the same");
    }
    if (its_program != program) {
      throw Failure(ExitCode::kUsage, name + " runs another build of version " + version + " than " + this->name() +
                                          "; all must run the same");
    }
    if (its_arguments != arguments) {
      throw Failure(ExitCode::kUsage, name + " was given other arguments than " + this->name());
    }
  }
}

void MpiRanks::report_failure(ExitCode code, const std::string& message) {
  // Without any check: this is the last that the process does.
  ByteWriter writer;
  writer.add(code);
  writer.add(name() + ": " + message);
  const Bytes bytes = writer.take();
  MPI_Request request = MPI_REQUEST_NULL;
  (void)MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, 0, kFailureTag, messages_, &request);
  const Stopwatch stopwatch;
  Patience patience;
  while (stopwatch.seconds() < kPatienceSeconds) {
    int ignored = 0;
    (void)MPI_Test(&request, &ignored, MPI_STATUS_IGNORE);
    patience.pause();
  }
  if (request != MPI_REQUEST_NULL) (void)MPI_Request_free(&request);
}

void MpiRanks::finish() {
  is_finishing_ = true;
  flush();
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ibarrier(messages_, &request), "wait for other ranks");
  wait_for(request);
  for (MPI_Comm* const communicator : {&messages_, &node_, &leaders_}) {
    if (*communicator != MPI_COMM_NULL) check(MPI_Comm_free(communicator), "free a communicator");
  }
  check(MPI_Finalize(), "end");
}

void MpiRanks::abort(int code) {
  (void)MPI_Abort(MPI_COMM_WORLD, code);
  ::_exit(code);
}

}  // namespace gridiron::tool
