// Ranks by MPI. Every wait looks for messages and failures of other ranks, and sleeps in between.
// Memory: messages under way. Threads: any one at a time (MPI_THREAD_SERIALIZED). SPDX-License-Identifier: Apache-2.0
#pragma once

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <deque>
#include <memory>
#include <string>

#include "base/failure.h"
#include "base/ranks.h"

namespace gridiron::tool {

/// The processes that mpirun has started. One object; MPI begins with it.
class MpiRanks final : public Ranks {
 public:
  MpiRanks();
  ~MpiRanks() override;

  [[nodiscard]] std::uint32_t rank() const override { return rank_; }
  [[nodiscard]] std::uint32_t count() const override { return count_; }
  void tell_first(Bytes message) override;
  [[nodiscard]] bool has_told() override;
  [[nodiscard]] std::optional<RankMessage> poll() override;
  void tell(std::uint32_t rank, Bytes message) override;
  [[nodiscard]] Bytes hear() override;
  void attend() override;
  void broadcast(Bytes& bytes) override;
  void share_bytes(std::span<std::byte> bytes, const char* what,
                   const std::function<void(std::uint64_t begin, std::span<std::byte> shared)>& place) override;
  [[nodiscard]] std::uint32_t usual_threads(std::uint32_t) const override { return threads_; }

  /// Compares what the ranks are, all of which call it. Errors: Failure (kUsage) on rank 0 if they are not alike.
  /// @param version    of the program.
  /// @param arguments  of the command line.
  void require_alike(const std::string& version, const std::string& arguments);

  /// "rank 3 on node7".
  [[nodiscard]] std::string name() const;

  /// Of another rank than 0: tells rank 0 of a failure and waits for the end of this process. @returns if rank 0 has
  /// not ended it after kPatienceSeconds.
  void report_failure(ExitCode code, const std::string& message);
  static constexpr double kPatienceSeconds = 3;

  /// Waits until all ranks are done, and ends MPI.
  void finish();
  /// Ends all ranks.
  [[noreturn]] static void abort(int code);

 private:
  // A message in pieces, as MPI counts bytes by int.
  struct Transfer {
    std::uint64_t byte_count = 0;
    std::uint32_t rank = 0;
    Bytes bytes;
    std::vector<MPI_Request> requests;

    [[nodiscard]] bool is_done();
  };

  void send(std::uint32_t rank, Bytes message);
  void start_pieces(Transfer& transfer, int tag, bool is_send);
  void look_for_failure();
  void look_for_message();
  void wait_for(MPI_Request& request);
  void broadcast_pieces(std::span<std::byte> bytes, MPI_Comm among);
  void meet_on_node();
  void flush();

  std::uint32_t rank_ = 0, count_ = 1, threads_ = 1;
  bool is_finishing_ = false;  ///< interrupts change nothing any more
  int on_node_ = 1, rank_on_node_ = 0;
  MPI_Comm messages_ = MPI_COMM_NULL;
  MPI_Comm node_ = MPI_COMM_NULL;
  MPI_Comm leaders_ = MPI_COMM_NULL;  ///< one rank of each node; null on the others
  std::unique_ptr<Transfer> told_;
  std::deque<std::unique_ptr<Transfer>> arriving_;
};

}  // namespace gridiron::tool
