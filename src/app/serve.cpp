#include "app/serve.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <thread>

#include "exec/error.hpp"
#include "io/json.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "report/page.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* loopback = "127.0.0.1";

/// 128 random bits as hexadecimal digits.
std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw IoError("the system gives no random bytes for a token");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

/// Takes as long for any two texts of one length.
bool equal(const std::string& given, const std::string& secret) {
  if (given.size() != secret.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |= static_cast<unsigned char>(given[i] ^ secret[i]);
  return difference == 0;
}

std::size_t frames_of(const std::string& folder) {
  return holds_frames(folder) ? frame_times(folder).size() : 0;
}

}  // namespace

struct ReportServer::Own {
  std::string folder;
  std::string token = random_token();
  int port = 0;
  httplib::Server server;
  std::thread thread;
  std::mutex building;      ///< one page at a time
  std::string page, shown;  ///< the last page, and the state that it is of

  Json state() const {
    const auto summary = read_json(read_whole_file(folder + "/summary.json"));
    return {{"status", summary.at("status")},
            {"step", summary.at("steps")},
            {"time", summary.at("time")},
            {"frames", frames_of(folder)}};
  }
  /// The page of this state; kept until there is another.
  std::string page_now() {
    const std::lock_guard lock(building);
    const std::string now = json_text(state());
    if (now == shown) return page;
    page = report::live_page_of(report::read_record(folder), now).html;
    shown = now;
    return page;
  }

  /// Other sites may send a browser here, by a name of theirs or without the token.
  bool allows(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host");
    const bool here =
        host == fmt::format("{}:{}", loopback, port) || host == fmt::format("localhost:{}", port);
    return here && equal(request.get_param_value("token"), token);
  }
  template <class Content>
  void answer(const char* path, const char* type, const Content& content) {
    server.Get(path, [this, type, content](const httplib::Request& request,
                                           httplib::Response& response) {
      if (!allows(request)) {
        response.status = 403;
        response.set_content("The address must be the one that breccia watch --serve has told.\n",
                             "text/plain");
        return;
      }
      try {
        response.set_content(content(), type);
      } catch (const std::exception& error) {  // a file that is being written, or is not yet there
        response.status = 503;
        response.set_content(std::string(error.what()) + "\n", "text/plain");
      }
    });
  }
};

ReportServer::ReportServer(std::string folder, int port) : own_(std::make_unique<Own>()) {
  own_->folder = std::move(folder);
  httplib::Server& server = own_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(4); };
  server.set_payload_max_length(4096);
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"Referrer-Policy", "no-referrer"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"}});
  own_->answer("/", "text/html; charset=utf-8", [own = own_.get()] { return own->page_now(); });
  own_->answer("/state", "application/json",
               [own = own_.get()] { return json_text(own->state()); });
  const bool bound = port == 0 ? (port = server.bind_to_any_port(loopback)) > 0
                               : server.bind_to_port(loopback, port);
  if (!bound)
    throw IoError(fmt::format("port {} of {} cannot be had; leave --port out", port, loopback));
  own_->port = port;
  own_->thread = std::thread([&server] { server.listen_after_bind(); });
}

ReportServer::~ReportServer() {
  while (!own_->server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  own_->server.stop();
  own_->thread.join();
}

std::string ReportServer::address() const {
  return fmt::format("http://{}:{}/?token={}", loopback, own_->port, own_->token);
}

}  // namespace breccia::app
