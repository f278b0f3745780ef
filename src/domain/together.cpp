#include "domain/together.hpp"

#include <new>
#include <string>

#include "exec/error.hpp"

namespace breccia {
namespace {

/// The kind of an error decides what its catchers do.
[[noreturn]] void throw_again(int code, const std::string& text) {
  switch (code) {
    case 2:
      throw InputError(text);
    case 3:
      throw IoError(text);
    case 4:
      throw NumericsError(text);
    case 5:
      throw DeviceError(text);
    case 7:
      throw CheckpointError(text);
    case 9:
      throw CheckFailed(text);
    default:
      throw Error(code, text);
  }
}

}  // namespace

void collective_try(Communicator* ranks, const std::function<void()>& work) {
  if (ranks == nullptr) return work();
  int code = 0;
  std::string text;
  const bool before = ranks->in_step();
  ranks->set_in_step(false);
  try {
    work();
  } catch (const Error& error) {
    code = error.exit_code();
    text = error.what();
  } catch (const std::bad_alloc&) {
    code = DeviceError("").exit_code();
    text = "not enough memory on rank " + std::to_string(ranks->rank());
  }
  const double lowest = ranks->least(code == 0 ? ranks->size() : ranks->rank());
  if (lowest >= ranks->size()) return ranks->set_in_step(before);
  Message message;
  put_value(message, code);
  put_array(message, std::vector<char>(text.begin(), text.end()));
  const Message told = ranks->from_all(message)[static_cast<std::size_t>(lowest)];
  ranks->set_in_step(true);
  Unpacking from(told);
  code = from.value<int>();
  const std::vector<char> characters = from.array<char>();
  throw_again(code, {characters.begin(), characters.end()});
}

}  // namespace breccia
