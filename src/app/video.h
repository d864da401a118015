#ifndef VERDURE_APP_VIDEO_H_
#define VERDURE_APP_VIDEO_H_

#include <string>

#include "verdure/image.h"

namespace verdure::app {

/// Pictures in a row: a film by the program ffmpeg (.mp4, .webm, .gif), or numbered pictures
/// (.png: clip.png becomes clip-0001.png and so on).
class Video {
 public:
  /// Throws Error for another kind of file, a place that cannot be written, a film without ffmpeg.
  Video(std::string path, int fps);
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;
  /// A film that was not finished leaves nothing; a process that is killed may leave
  /// `.NAME.PID.mp4`.
  ~Video();

  /// All of one size. `number`: of the frame, in the names of pictures.
  void add(const Image& image, int number);
  /// The film gets its name.
  void finish();

 private:
  void start(int width, int height);

  std::string path_, unfinished_;
  int fps_;
  int pipe_ = -1;
  int process_ = -1;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIDEO_H_
