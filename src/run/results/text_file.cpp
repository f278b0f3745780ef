#include "run/results/text_file.hpp"

#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia {

LineFile::LineFile(const std::string& path)
    : path_(path), file_(path, File::Use::append), size_(file_.size()) {}

void LineFile::append(std::string_view line) {
  std::string whole(line);
  whole += '\n';
  try {
    file_.write(bytes_of(whole));
  } catch (const IoError&) {
    file_.cut(size_);
    throw;
  }
  size_ += whole.size();
}

void LineFile::sync() {
  file_.sync();
  if (!file_.in_place()) throw IoError(path_ + ": cannot write: it was moved or removed");
}

void keep_lines(const std::string& path, const std::function<bool(std::string_view)>& keep) {
  if (!std::filesystem::exists(path)) return;
  const std::string text = read_whole_file(path);
  std::string kept;
  std::string_view rest = text;
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    if (keep(rest.substr(0, end))) kept += rest.substr(0, end + 1);
    rest.remove_prefix(end + 1);
  }
  if (kept != text) replace_durably(path, kept);
}

}  // namespace breccia
