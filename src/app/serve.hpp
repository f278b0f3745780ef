#pragma once
// The report of a run in a browser of this machine, while the run goes on.

#include <memory>
#include <string>

namespace breccia::app {

/// Answers browsers on 127.0.0.1, in threads of its own, as long as it lives. Whoever asks must
/// know the token, which is drawn anew for each server. Two addresses exist: `/`, the report as the
/// folder is now, and `/state`, how far the run is, as JSON. No part of a request names a file.
class ReportServer {
 public:
  /// @param folder  the result folder of the run
  /// @param port    0: one that is free
  /// @throws IoError if the port cannot be had
  ReportServer(std::string folder, int port);
  ReportServer(const ReportServer&) = delete;
  ReportServer& operator=(const ReportServer&) = delete;
  ~ReportServer();

  /// For the browser, with the token.
  std::string address() const;

 private:
  struct Own;
  std::unique_ptr<Own> own_;
};

}  // namespace breccia::app
