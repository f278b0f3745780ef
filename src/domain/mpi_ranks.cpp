#include "domain/mpi_ranks.hpp"

#if defined(BR_MPI)
#define OMPI_SKIP_MPICXX 1  // the C++ interface that MPI has given up
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#if __has_include(<mpi-ext.h>)
#include <mpi-ext.h>  // Open MPI's own calls
#endif
#endif

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <thread>

#include "core/case_config.hpp"
#include "domain/peer_link.hpp"
#include "domain/shared_reduction.hpp"
#include "domain/watchdog.hpp"
#include "exec/error.hpp"

namespace breccia {

#if defined(BR_MPI)
namespace {

/// @throws DeviceError naming the call that failed
void must(int code, const char* call) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw DeviceError(std::string(call) + ": " + text);
}

/// Whether this MPI sends from a GPU's memory and receives there.
bool reaches_gpus() {
#if defined(MPIX_CUDA_AWARE_SUPPORT) && MPIX_CUDA_AWARE_SUPPORT
  static const bool yes = MPIX_Query_cuda_support() == 1;
  return yes;
#elif defined(MPIX_GPU_SUPPORT_CUDA)
  static const bool yes = [] {
    int supported = 0;
    return MPIX_GPU_query_support(MPIX_GPU_SUPPORT_CUDA, &supported) == MPI_SUCCESS &&
           supported != 0;
  }();
  return yes;
#else
  return false;
#endif
}

/// Memory that the ranks of one machine share: a sign of life of each, and what each votes for.
class SharedSigns {
 public:
  explicit SharedSigns(MPI_Comm here) {
    int size = 0, rank = 0, unit = 0;
    must(MPI_Comm_size(here, &size), "MPI_Comm_size");
    must(MPI_Comm_rank(here, &rank), "MPI_Comm_rank");
    // MPI aligns it for numbers, not for lines of the cache; mapped by pages, it begins alike in
    // all.
    static_assert(alignof(LifeSign) >= alignof(VoteSlot));
    const std::size_t all = static_cast<std::size_t>(size) * (sizeof(LifeSign) + sizeof(VoteSlot));
    const auto own = static_cast<MPI_Aint>(rank == 0 ? all + alignof(LifeSign) : 0);
    void* memory = nullptr;
    must(MPI_Win_allocate_shared(own, 1, MPI_INFO_NULL, here, &memory, &window_),
         "MPI_Win_allocate_shared");
    MPI_Aint bytes = 0;
    must(MPI_Win_shared_query(window_, 0, &bytes, &unit, &memory), "MPI_Win_shared_query");
    auto room = static_cast<std::size_t>(bytes);
    std::align(alignof(LifeSign), all, memory, room);
    auto* const first = static_cast<LifeSign*>(memory);
    signs_ = {first, static_cast<std::size_t>(size)};
    votes_ = {reinterpret_cast<VoteSlot*>(first + size), static_cast<std::size_t>(size)};
    if (rank == 0) {
      for (LifeSign& sign : signs_) new (&sign) LifeSign{};
      for (VoteSlot& vote : votes_) new (&vote) VoteSlot{};
    }
    must(MPI_Barrier(here), "MPI_Barrier");
    world_rank_.resize(signs_.size());
    int self = 0;
    must(MPI_Comm_rank(MPI_COMM_WORLD, &self), "MPI_Comm_rank");
    must(MPI_Allgather(&self, 1, MPI_INT, world_rank_.data(), 1, MPI_INT, here), "MPI_Allgather");
    self_ = static_cast<std::size_t>(rank);
  }
  SharedSigns(const SharedSigns&) = delete;
  SharedSigns& operator=(const SharedSigns&) = delete;
  ~SharedSigns() { MPI_Win_free(&window_); }

  std::span<LifeSign> all() const { return signs_; }
  std::span<VoteSlot> votes() const { return votes_; }
  std::size_t self() const { return self_; }
  std::string name_of(std::size_t place) const {
    return place < world_rank_.size() ? "rank " + std::to_string(world_rank_[place])
                                      : "a rank on another machine";
  }
  /// True for the first one on this machine that asks.
  bool may_tell() const { return signs_[0].told.exchange(1) == 0; }

 private:
  MPI_Win window_ = MPI_WIN_NULL;
  std::span<LifeSign> signs_;
  std::span<VoteSlot> votes_;
  std::vector<int> world_rank_;
  std::size_t self_ = 0;
};

class MpiRanks final : public Communicator {
 public:
  MpiRanks() {
    // Ranks that wait let others have the processor, unless the user has chosen: on a machine that
    // is shared a rank that spins keeps the one that it waits for from running. Open MPI only.
    ::setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
    // Copies of a step, some 10 kB a neighbour, go through shared memory at once instead of being
    // announced first: half the time on one machine.
    ::setenv("OMPI_MCA_btl_vader_eager_limit", "65536", 0);
    ::setenv("OMPI_MCA_btl_vader_max_send_size", "131072", 0);
    int provided = 0;
    must(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
    must(MPI_Comm_dup(MPI_COMM_WORLD, &all_), "MPI_Comm_dup");
    must(MPI_Comm_set_errhandler(all_, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
    must(MPI_Comm_rank(all_, &rank_), "MPI_Comm_rank");
    must(MPI_Comm_size(all_, &size_), "MPI_Comm_size");
    MPI_Comm here = MPI_COMM_NULL;
    must(MPI_Comm_split_type(all_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here),
         "MPI_Comm_split_type");
    must(MPI_Comm_size(here, &here_), "MPI_Comm_size");
    signs_.emplace(here);
    must(MPI_Comm_rank(here, &number_here_), "MPI_Comm_rank");
    // Few enough to be read one by one; ranks of one machine are numbered as all are.
    if (here_ == size_ && size_ <= 64) board_.emplace(signs_->votes(), signs_->self());
    MPI_Comm_free(&here);
    if (here_ == size_) link_.emplace(*this, Space::cuda);
    watchdog_.emplace(signs_->all(), signs_->self(), [this](std::size_t place) { lose(place); });
    watchdog_->set_patience(DomainConfig{}.patience);
  }
  ~MpiRanks() override {
    if (link_) link_->close();
    watchdog_.reset();
    signs_.reset();
    MPI_Comm_free(&all_);
    MPI_Finalize();  // all have come here before one ends its link
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int on_this_machine() const { return here_; }
  bool reaches(Space space) const override {
    return space == Space::host || (space == Space::cuda && reaches_gpus());
  }
  PeerLink* link() override { return link_ ? &*link_ : nullptr; }
  void set_patience(double seconds) override { watchdog_->set_patience(seconds); }
  double waited() const override { return std::chrono::duration<double>(waited_).count(); }
  double worked() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_ - waited_)
        .count();
  }
  int number_on_this_machine() const { return number_here_; }

  std::unique_ptr<RepeatedMessages> prepare(const std::vector<Post>& to,
                                            const std::vector<Post>& from) override {
    return std::make_unique<Repeated>(*this, to, from);
  }

  std::vector<Message> exchange(std::vector<Message> messages) override {
    const auto count = static_cast<std::size_t>(size_);
    std::vector<std::int64_t> sent(count), coming(count);
    std::optional<Waiting> waiting(*this);
    for (std::size_t r = 0; r < count; ++r) sent[r] = static_cast<std::int64_t>(messages[r].size());
    must(MPI_Alltoall(sent.data(), 1, MPI_INT64_T, coming.data(), 1, MPI_INT64_T, all_),
         "MPI_Alltoall");
    waiting.reset();
    std::vector<Message> came(count);
    std::vector<Post> to, from;
    for (std::size_t r = 0; r < count; ++r) {
      if (static_cast<int>(r) == rank_) continue;
      came[r].resize(static_cast<std::size_t>(coming[r]));
      from.push_back({static_cast<int>(r), came[r].data(), came[r].size()});
      to.push_back({static_cast<int>(r), messages[r].data(), messages[r].size()});
    }
    Repeated once(*this, to, from);
    once.start();
    once.finish();
    came[static_cast<std::size_t>(rank_)] = std::move(messages[static_cast<std::size_t>(rank_)]);
    return came;
  }

  double least(double value) override {
    const Waiting waiting(*this);
    if (board_) {
      board_->publish(std::bit_cast<std::uint64_t>(value));
      collect([&value](std::uint64_t told) {
        const auto other = std::bit_cast<double>(told);
        if (other < value) value = other;
      });
      return value;
    }
    double result = value;
    must(MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, MPI_MIN, all_), "MPI_Allreduce");
    return result;
  }
  void start_any_of(std::uint64_t bits) override {
    if (board_) return board_->publish(bits);
    own_bits_ = bits;
    must(MPI_Iallreduce(&own_bits_, &voted_bits_, 1, MPI_UINT64_T, MPI_BOR, all_, &vote_),
         "MPI_Iallreduce");
  }
  std::uint64_t finish_any_of() override {
    const Waiting waiting(*this);
    if (!board_) {
      must(MPI_Wait(&vote_, MPI_STATUS_IGNORE), "MPI_Wait");
      return voted_bits_;
    }
    std::uint64_t bits = 0;
    collect([&bits](std::uint64_t told) { bits |= told; });
    return bits;
  }
  std::uint64_t any_of(std::uint64_t bits) override {
    if (board_) {
      start_any_of(bits);
      return finish_any_of();
    }
    const Waiting waiting(*this);
    std::uint64_t result = bits;
    must(MPI_Allreduce(&bits, &result, 1, MPI_UINT64_T, MPI_BOR, all_), "MPI_Allreduce");
    return result;
  }
  void add_up(std::span<std::int64_t> numbers) override {
    const Waiting waiting(*this);
    must(MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_INT64_T,
                       MPI_SUM, all_),
         "MPI_Allreduce");
  }
  Message from_first(Message message) override {
    const Waiting waiting(*this);
    auto bytes = static_cast<std::int64_t>(message.size());
    must(MPI_Bcast(&bytes, 1, MPI_INT64_T, 0, all_), "MPI_Bcast");
    message.resize(static_cast<std::size_t>(bytes));
    must(MPI_Bcast(message.data(), static_cast<int>(bytes), MPI_BYTE, 0, all_), "MPI_Bcast");
    return message;
  }
  std::vector<Message> from_all(const Message& message) override {
    const auto count = static_cast<std::size_t>(size_);
    const auto own = static_cast<std::int64_t>(message.size());
    std::vector<std::int64_t> bytes(count);
    std::optional<Waiting> waiting(*this);
    must(MPI_Allgather(&own, 1, MPI_INT64_T, bytes.data(), 1, MPI_INT64_T, all_), "MPI_Allgather");
    std::vector<int> counts, begins;
    std::int64_t total = 0;
    for (const std::int64_t each : bytes) {
      counts.push_back(static_cast<int>(each));
      begins.push_back(static_cast<int>(total));
      total += each;
    }
    if (total > std::numeric_limits<int>::max()) {  // MPI counts in int
      waiting.reset();
      return Communicator::from_all(message);
    }
    Message all(static_cast<std::size_t>(total));
    must(MPI_Allgatherv(message.data(), counts[static_cast<std::size_t>(rank_)], MPI_BYTE,
                        all.data(), counts.data(), begins.data(), MPI_BYTE, all_),
         "MPI_Allgatherv");
    std::vector<Message> came;
    for (std::size_t r = 0; r < count; ++r) {
      const auto* const begin = all.data() + begins[r];
      came.emplace_back(begin, begin + counts[r]);
    }
    return came;
  }
  void abort(int exit_code) override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

 private:
  static constexpr int tag = 1;
  static constexpr int rank_lost = 8;  // exit code

  /// While this rank needs an answer.
  class Waiting {
   public:
    explicit Waiting(MpiRanks& ranks) : ranks_(ranks) { ranks_.watchdog_->begin_waiting(); }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;
    ~Waiting() {
      ranks_.watchdog_->end_waiting();
      ranks_.waited_ += std::chrono::steady_clock::now() - begin_;
    }

   private:
    MpiRanks& ranks_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  };

  /// While it waits, this rank brings its own messages on their way and, in time, lets others have
  /// the processor: there may be fewer of them than ranks.
  template <class Visit>
  void collect(const Visit& visit) {
    constexpr int patient = 200;
    int rounds = 0;
    const auto idle = [&] {
      if (++rounds < patient) return pause_processor();
      int any = 0;
      must(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, all_, &any, MPI_STATUS_IGNORE), "MPI_Iprobe");
      std::this_thread::yield();
    };
    board_->collect(idle, visit);
  }
  static void pause_processor() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }

  /// On the watchdog's thread: one rank tells, and all end.
  void lose(std::size_t place) {
    if (!signs_->may_tell())
      std::this_thread::sleep_for(std::chrono::seconds(3));
    else
      std::fprintf(stderr,
                   "error: %s has not answered for %g s or more; all ranks end\n"
                   "  go on from the last checkpoint with breccia resume\n"
                   "  [domain] patience says how long ranks wait for each other\n",
                   signs_->name_of(place).c_str(), watchdog_->patience());
    std::fflush(stderr);
    // Should MPI itself hang, too.
    std::thread([] {
      std::this_thread::sleep_for(std::chrono::seconds(2));
      ::_exit(rank_lost);
    }).detach();
    abort(rank_lost);
  }

  /// Requests that MPI keeps ready.
  class Repeated final : public RepeatedMessages {
   public:
    Repeated(MpiRanks& ranks, const std::vector<Post>& to, const std::vector<Post>& from)
        : ranks_(ranks) {
      for (const Post& post : from) each_part(post, "MPI_Recv_init", MPI_Recv_init);
      for (const Post& post : to) each_part(post, "MPI_Send_init", MPI_Send_init);
    }
    ~Repeated() override {
      for (MPI_Request& request : requests_) MPI_Request_free(&request);
    }
    void start() override {
      // One by one: parts of a message must not overtake each other.
      for (MPI_Request& request : requests_) must(MPI_Start(&request), "MPI_Start");
    }
    void finish() override {
      const Waiting waiting(ranks_);
      must(MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE),
           "MPI_Waitall");
    }

   private:
    /// MPI counts in int: longer messages go in parts.
    static constexpr std::size_t longest = std::size_t{1} << 30;

    template <class Prepare>
    void each_part(const Post& post, const char* call, const Prepare& prepare) {
      for (std::size_t done = 0; done < post.bytes; done += longest)
        must(prepare(static_cast<std::byte*>(post.data) + done,
                     static_cast<int>(std::min(longest, post.bytes - done)), MPI_BYTE, post.rank,
                     tag, ranks_.all_, &requests_.emplace_back()),
             call);
    }

    MpiRanks& ranks_;
    std::vector<MPI_Request> requests_;
  };

  MPI_Comm all_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1, here_ = 1, number_here_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::duration waited_{};
  MPI_Request vote_ = MPI_REQUEST_NULL;
  std::uint64_t own_bits_ = 0, voted_bits_ = 0;
  std::optional<SharedSigns> signs_;
  std::optional<SharedReduction> board_;  ///< if all ranks are on this machine
  std::optional<PeerLink> link_;          ///< if all ranks are on this machine
  std::optional<Watchdog> watchdog_;
};

/// Whether a launcher has started this process: of Open MPI, MPICH, or a cluster's own.
bool launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "PMIX_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

}  // namespace

bool built_with_mpi() {
  return true;
}
std::unique_ptr<Communicator> launched_ranks() {
  if (!launched()) return nullptr;
  auto ranks = std::make_unique<MpiRanks>();
  return ranks;
}
int ranks_on_this_machine(Communicator* ranks) {
  const auto* mpi = dynamic_cast<const MpiRanks*>(ranks);
  return mpi == nullptr ? 1 : mpi->on_this_machine();
}
int number_on_this_machine(Communicator* ranks) {
  const auto* mpi = dynamic_cast<const MpiRanks*>(ranks);
  return mpi == nullptr ? 0 : mpi->number_on_this_machine();
}

#else

bool built_with_mpi() {
  return false;
}
std::unique_ptr<Communicator> launched_ranks() {
  // Every rank would run the whole case and fight for the same folder.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* const size = std::getenv(name);
    if (size != nullptr && std::string(size) != "1")
      throw DeviceError(
          "started on several ranks, but this build of breccia has no MPI; nothing was run\n"
          "  install libopenmpi-dev or libmpich-dev and build again");
  }
  return nullptr;
}
int ranks_on_this_machine(Communicator*) {
  return 1;
}
int number_on_this_machine(Communicator*) {
  return 0;
}

#endif

}  // namespace breccia
