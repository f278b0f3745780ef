#include "api/guard.hpp"
#include "run/machine/machine.hpp"

namespace br {

Case::Case(std::shared_ptr<const Read> read) : read_(std::move(read)) {}

Case::Case(const std::string& path, const std::vector<std::string>& overrides)
    : Case(guarded([&] {
        return std::make_shared<const Read>(Read{breccia::load_case(path, overrides)});
      })) {}

Case Case::from_text(const std::string& text, const std::string& name, const std::string& folder,
                     const std::vector<std::string>& overrides) {
  return Case(guarded([&] {
    return std::make_shared<const Read>(Read{breccia::case_of_text(text, name, folder, overrides)});
  }));
}

const std::string& Case::name() const {
  return read_->read.name;
}
const std::string& Case::text() const {
  return read_->read.text;
}
const std::string& Case::digest() const {
  return read_->read.digest;
}
std::string Case::method() const {
  return read_->read.common().method;
}
double Case::end_time() const {
  return read_->read.common().time.end;
}

std::string version() {
  return breccia::this_build().version;
}

}  // namespace br
