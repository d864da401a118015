// Drops files on a window of an X display, as a file manager would (XDND, version 5):
//   drop_files WINDOW PATH...
// Ends with 0 once the window has taken them, with 1 if it refuses or does not answer.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

constexpr unsigned kSeconds = 20;

/// With all but letters, digits and few signs as %XX.
std::string uriOf(const std::filesystem::path& path) {
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(path).string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    std::array<char, 4> code{};
    std::snprintf(code.data(), code.size(), "%%%02X", static_cast<unsigned char>(c));
    uri += plain ? std::string(1, c) : code.data();
  }
  return uri + "\r\n";
}

class Source {
 public:
  Source(Display* display, Window target, std::string uris)
      : display_(display),
        target_(target),
        window_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)),
        uris_(std::move(uris)) {
    XSetSelectionOwner(display_, atom("XdndSelection"), window_, CurrentTime);
  }

  bool drop() {
    const auto source = static_cast<long>(window_);
    send("XdndEnter", {source, 5L << 24, static_cast<long>(atom("text/uri-list")), 0, 0});
    int x = 0, y = 0;  // of the target's middle, on the screen
    Window child = None;
    XWindowAttributes size;
    XGetWindowAttributes(display_, target_, &size);
    XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), size.width / 2,
                          size.height / 2, &x, &y, &child);
    send("XdndPosition",
         {source, 0, long{x} << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy"))});
    if ((answer("XdndStatus") & 1) == 0) return false;
    send("XdndDrop", {source, 0, CurrentTime, 0, 0});
    return answer("XdndFinished") != 0;  // GLFW 3.3 says how many bytes it took
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

  void send(const char* what, const std::array<long, 5>& data) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(what);
    event.xclient.format = 32;
    for (std::size_t i = 0; i < data.size(); ++i) event.xclient.data.l[i] = data[i];
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }

  /// The flags of the target's message of that name; meanwhile it gets the names that it asks for.
  long answer(const char* what) {
    for (;;) {
      XEvent event;
      XNextEvent(display_, &event);
      if (event.type == ClientMessage && event.xclient.message_type == atom(what))
        return event.xclient.data.l[1];
      if (event.type == SelectionRequest) give(event.xselectionrequest);
    }
  }

  void give(const XSelectionRequestEvent& asked) {
    XChangeProperty(display_, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris_.data()),
                    static_cast<int>(uris_.size()));
    XEvent given{};
    given.xselection.type = SelectionNotify;
    given.xselection.requestor = asked.requestor;
    given.xselection.selection = asked.selection;
    given.xselection.target = asked.target;
    given.xselection.property = asked.property;
    given.xselection.time = asked.time;
    XSendEvent(display_, asked.requestor, False, NoEventMask, &given);
    XFlush(display_);
  }

  Display* display_;
  Window target_, window_;
  std::string uris_;
};

}  // namespace

int main(int argc, char** argv) {
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr || argc < 3) {
    std::fprintf(stderr, "usage: drop_files WINDOW PATH..., on a display\n");
    return 2;
  }
  alarm(kSeconds);  // ends it where the window does not answer
  std::string uris;
  for (int i = 2; i < argc; ++i) uris += uriOf(argv[i]);
  return Source(display, std::strtoul(argv[1], nullptr, 0), uris).drop() ? 0 : 1;
}
