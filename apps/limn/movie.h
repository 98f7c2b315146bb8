// Writes movies through the program ffmpeg, which gets raw frames through a pipe.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "core/base/file.h"
#include "core/image/image.h"

namespace limn::app {

/// Returns whether files of that name are movies: .mp4 (H.264), .webm (VP9), .gif.
bool isMovie(const std::filesystem::path& file);

/// Throws Error naming the package where there is no ffmpeg.
void checkMovieProgram();

/// Writes one movie, to a file beside the one that is asked for, which takes its place in the end. Without
/// finish() nothing is left.
class Movie {
 public:
  /// `command` and limn's version are kept in the metadata of .mp4 and .webm.
  Movie(std::filesystem::path file, double fps, std::string command);
  ~Movie();
  Movie(const Movie&) = delete;
  Movie& operator=(const Movie&) = delete;

  /// Adds a frame, whose size must be that of the first. Throws Error with what ffmpeg says when it fails.
  void add(const Image8& frame);
  /// Completes the movie. Throws Error with what ffmpeg says when it fails.
  void finish();

 private:
  void start(int width, int height);
  [[noreturn]] void fail(const std::string& ending);
  void closeInput();

  std::filesystem::path file_;
  TemporaryFile part_;
  double fps_;
  std::string command_;
  pid_t process_ = 0;  ///< 0: not started, or ended
  int input_ = -1, words_ = -1;
};

}  // namespace limn::app
