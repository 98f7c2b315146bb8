#include "apps/limn/movie.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/spawn.h"
#include "core/base/text.h"
#include "core/base/version.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kEncoder = "ffmpeg";

/// What a kind of file needs of ffmpeg.
struct MovieKind {
  const char* extension;
  std::vector<std::string> arguments;
};

/// Sides of H.264 and VP9 in 4:2:0 are even; a row or column more is black. Colours are said to be what they
/// are: sRGB primaries, through the matrix of BT.709.
std::vector<std::string> encoded(std::vector<std::string> codec) {
  std::vector<std::string> arguments = {"-vf",
                                        "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709",
                                        "-pix_fmt",
                                        "yuv420p",
                                        "-colorspace",
                                        "bt709",
                                        "-color_primaries",
                                        "bt709",
                                        "-color_trc",
                                        "iec61966-2-1"};
  arguments.insert(arguments.end(), codec.begin(), codec.end());
  return arguments;
}

const std::vector<MovieKind>& kinds() {
  static const std::vector<MovieKind> all = {
      {".mp4", encoded({"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"})},
      {".webm", encoded({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-f", "webm"})},
      {".gif",
       {"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-loop", "0", "-f", "gif"}}};
  return all;
}

const MovieKind* kindOf(const fs::path& file) {
  for (const MovieKind& kind : kinds())
    if (file.extension() == kind.extension) return &kind;
  return nullptr;
}

/// What a file holds from its beginning.
std::string textOf(int file) {
  std::string text(4096, '\0');
  const ssize_t size = pread(file, text.data(), text.size(), 0);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return text;
}

}  // namespace

bool isMovie(const fs::path& file) {
  return kindOf(file) != nullptr;
}

void checkMovieProgram() {
  if (!programExists(kEncoder))
    throw Error("movies are written by ffmpeg, which is not installed: apt-get install ffmpeg");
}

Movie::Movie(fs::path file, double fps, std::string command)
    : file_(std::move(file)), part_(file_), fps_(fps), command_(std::move(command)) {}

Movie::~Movie() {
  closeInput();
  if (process_ > 0) endProgram(process_);
  if (words_ >= 0) close(words_);
}

void Movie::closeInput() {
  if (input_ >= 0) close(std::exchange(input_, -1));
}

void Movie::start(int width, int height) {
  int ends[2];
  // A socket, because writing to one whose reader has gone raises no signal.
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw Error(
        fmt::format("{}: no frames can be handed to ffmpeg: {}", file_.string(), std::strerror(errno)));
  input_ = ends[0];
  words_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  std::vector<std::string> arguments = {"-hide_banner",
                                        "-loglevel",
                                        "error",
                                        "-y",
                                        "-f",
                                        "rawvideo",
                                        "-pixel_format",
                                        "rgba",
                                        "-video_size",
                                        fmt::format("{}x{}", width, height),
                                        "-framerate",
                                        fmt::format("{}", fps_),
                                        "-i",
                                        "pipe:0",
                                        "-metadata",
                                        "comment=" + command_,
                                        "-metadata",
                                        fmt::format("description=limn {}", version())};
  const std::vector<std::string>& of = kindOf(file_)->arguments;
  arguments.insert(arguments.end(), of.begin(), of.end());
  arguments.push_back("file:" + part_.path().string());
  try {
    process_ = startProgram(kEncoder, arguments, {ends[1], -1, words_});
  } catch (...) {
    close(ends[1]);
    throw;
  }
  close(ends[1]);
}

void Movie::fail(const std::string& ending) {
  const std::string words = oneLine(textOf(words_), 300);
  throw Error(fmt::format("{}: ffmpeg failed: {}", file_.string(), words.empty() ? ending : words));
}

void Movie::add(const Image8& frame) {
  if (process_ == 0) start(frame.width, frame.height);
  for (std::size_t sent = 0; sent < frame.data.size();) {
    const ssize_t count = send(input_, frame.data.data() + sent, frame.data.size() - sent, MSG_NOSIGNAL);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      const int error = errno;
      closeInput();
      fail(fmt::format("{}, {}", std::strerror(error), awaitProgram(std::exchange(process_, 0))));
    }
  }
}

void Movie::finish() {
  closeInput();
  if (const std::string ending = awaitProgram(std::exchange(process_, 0)); !ending.empty()) fail(ending);
  part_.keep();
}

}  // namespace limn::app
