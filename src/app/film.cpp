#include "app/film.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include "exec/error.hpp"
#include "io/file.hpp"
#include "io/whole_file.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

/// The program on the PATH; empty if it is not there.
std::string ffmpeg() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const std::string file = folder + "/ffmpeg"; ::access(file.c_str(), X_OK) == 0) return file;
  return {};
}

/// How ffmpeg encodes a film by the end of its name.
std::vector<std::string> encoding(const std::string& path) {
  if (path.ends_with(".gif"))
    return {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"};
  const std::string even = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white";  // as 4:2:0 wants it
  if (path.ends_with(".webm"))
    return {"-vf", even,      "-c:v", "libvpx-vp9", "-crf",    "30", "-b:v",
            "0",   "-row-mt", "1",    "-pix_fmt",   "yuv420p", "-f", "webm"};
  return {"-vf",      even,      "-c:v",      "libx264",    "-crf", "18",
          "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f",   "mp4"};
}

/// Puts a comment behind the head of a GIF: ffmpeg writes none there (GIF89a, sections 18 and 24).
void add_comment(const std::string& path, const std::string& note) {
  const std::string film = read_whole_file(path);
  constexpr std::size_t signature = 6, screen = 7, flags = 10, most = 255;
  if (film.size() < signature + screen) throw IoError(path + ": ffmpeg left no film");
  const int packed = static_cast<unsigned char>(film[flags]);
  std::size_t head = signature + screen;
  if ((packed & 0x80) != 0) head += std::size_t{3} << ((packed & 7) + 1);  // its colours
  head = std::min(head, film.size());
  std::string comment("\x21\xfe");
  for (std::size_t from = 0; from < note.size(); from += most) {
    const std::string part = note.substr(from, most);
    comment += static_cast<char>(static_cast<unsigned char>(part.size()));
    comment += part;
  }
  comment += '\0';
  const std::string_view all = film;
  const Bytes pieces[] = {bytes_of(all.substr(0, head)), bytes_of(comment),
                          bytes_of(all.substr(head))};
  replace_file(path, pieces);
}

}  // namespace

FILE* decoded(const std::string& path, int width, int height) {
  const std::string program = ffmpeg();
  if (program.empty())
    throw IoError(path + ": films are read by the program ffmpeg, which is not here");
  std::string quoted;
  for (const char c : path) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  const std::string command = fmt::format(
      "'{}' -nostdin -loglevel fatal -i 'file:{}' -vsync passthrough -vf "
      "format=rgb24,crop={}:{}:0:0 -f rawvideo -",
      program, quoted, width, height);
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw IoError(path + ": cannot be read: no pipe from ffmpeg");
  return pipe;
}

bool is_film(const std::string& path) {
  return path.ends_with(".mp4") || path.ends_with(".webm") || path.ends_with(".gif");
}

Film::Film(const std::string& path, int rate, std::string note)
    : path_(path), temporary_(path + ".tmp"), note_(std::move(note)), rate_(rate) {
  if (ffmpeg().empty())
    throw IoError(
        path +
        ": films are made by the program ffmpeg, which is not here; install it (Debian: apt "
        "install ffmpeg), or make a sheet of pictures: --sheet 3x2 -o sheet.png");
  ::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that ended is an error of the write call
}

Film::~Film() {
  if (pipe_ >= 0) ::close(pipe_);
  if (child_ > 0) ::waitpid(child_, nullptr, 0);
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void Film::start(const Image& first) {
  width_ = first.width;
  height_ = first.height;
  std::vector<std::string> words{ffmpeg(),
                                 "-y",
                                 "-loglevel",
                                 "error",
                                 "-f",
                                 "rawvideo",
                                 "-pixel_format",
                                 "rgb24",
                                 "-video_size",
                                 fmt::format("{}x{}", width_, height_),
                                 "-framerate",
                                 std::to_string(rate_),
                                 "-i",
                                 "-",
                                 "-metadata",
                                 "comment=" + note_};
  for (const std::string& word : encoding(path_)) words.push_back(word);
  words.push_back("file:" + temporary_);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int ends[2];
  if (::pipe(ends) != 0) throw IoError(path_ + ": cannot be written: no pipe to ffmpeg");
  child_ = ::fork();
  if (child_ == 0) {
    ::dup2(ends[0], STDIN_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ::close(ends[0]);
  pipe_ = ends[1];
  if (child_ < 0) fail();
}

void Film::add(const Image& image) {
  if (child_ < 0) start(image);
  if (image.width != width_ || image.height != height_)
    throw InputError(path_ + ": the pictures of a film must be of one size");
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t more = ::write(pipe_, image.rgb.data() + sent, image.rgb.size() - sent);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) fail();
    sent += static_cast<std::size_t>(more);
  }
}

bool Film::ran(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  int status = 0;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

void Film::put_comment() {
  if (path_.ends_with(".gif")) return add_comment(temporary_, note_);
  const std::string other = temporary_ + "2", texts = temporary_ + ".txt";
  // In a file, since an argument of a program is at most 128 KiB long.
  std::string lines = ";FFMETADATA1\ncomment=";
  for (const char c : note_) {
    if (c == '=' || c == ';' || c == '#' || c == '\\' || c == '\n') lines += '\\';
    lines += c;
  }
  replace_file(texts, lines + "\n");
  const bool good = ran({ffmpeg(),
                         "-y",
                         "-nostdin",
                         "-loglevel",
                         "error",
                         "-i",
                         "file:" + temporary_,
                         "-f",
                         "ffmetadata",
                         "-i",
                         "file:" + texts,
                         "-map",
                         "0",
                         "-map_metadata",
                         "1",
                         "-c",
                         "copy",
                         "-movflags",
                         "+faststart",
                         "-f",
                         path_.ends_with(".webm") ? "webm" : "mp4",
                         "file:" + other});
  std::error_code error;
  fs::remove(texts, error);
  if (good) fs::rename(other, temporary_, error);
  if (good && !error) return;
  fs::remove(other, error);
  fail();
}

void Film::close(const std::string& more) {
  ::close(pipe_);
  pipe_ = -1;
  int status = 0;
  ::waitpid(child_, &status, 0);
  child_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
  if (!more.empty()) note_ += "\n" + more;
  if (!more.empty() || path_.ends_with(".gif")) put_comment();
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw IoError(path_ + ": cannot be written: " + error.message());
}

void Film::fail() {
  throw IoError(path_ + ": cannot be written: ffmpeg ended early; its words are above");
}

}  // namespace breccia::app
