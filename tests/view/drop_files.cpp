// Drops files on a window as a file manager does (XDND version 5): limn_drop_files WINDOW FILE...
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

constexpr long kVersion = 5;

class DragSource {
 public:
  DragSource(Display* display, Window target, std::string uris)
      : display_(display),
        target_(target),
        self_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)),
        uris_(std::move(uris)) {}

  /// True if the window took them.
  bool drop() {
    XSetSelectionOwner(display_, atom("XdndSelection"), self_, CurrentTime);
    const auto list = static_cast<long>(atom("text/uri-list"));
    say("XdndEnter", {kVersion << 24, list, 0, 0});
    say("XdndPosition", {0, 0, CurrentTime, static_cast<long>(atom("XdndActionCopy"))});
    for (XEvent event;;) {
      XNextEvent(display_, &event);
      if (event.type == SelectionRequest) give(event.xselectionrequest);
      if (event.type != ClientMessage) continue;
      if (event.xclient.message_type == atom("XdndStatus")) {
        if ((event.xclient.data.l[1] & 1) == 0) return false;
        say("XdndDrop", {0, CurrentTime, 0, 0});
      }
      // The first bit by the protocol; GLFW 3.3 answers with the number of bytes that it got.
      if (event.xclient.message_type == atom("XdndFinished")) return event.xclient.data.l[1] != 0;
    }
  }

 private:
  Atom atom(const char* name) { return XInternAtom(display_, name, False); }

  void say(const char* what, const long (&data)[4]) {
    XEvent event{};
    event.xclient = {.type = ClientMessage,
                     .serial = 0,
                     .send_event = True,
                     .display = display_,
                     .window = target_,
                     .message_type = atom(what),
                     .format = 32,
                     .data = {.l = {static_cast<long>(self_), data[0], data[1], data[2], data[3]}}};
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }

  void give(const XSelectionRequestEvent& request) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
    XEvent event{};
    event.xselection = {.type = SelectionNotify,
                        .serial = 0,
                        .send_event = True,
                        .display = display_,
                        .requestor = request.requestor,
                        .selection = request.selection,
                        .target = request.target,
                        .property = request.property,
                        .time = request.time};
    XSendEvent(display_, request.requestor, False, NoEventMask, &event);
    XFlush(display_);
  }

  Display* display_;
  Window target_, self_;
  std::string uris_;
};

}  // namespace

int main(int argc, char** argv) {
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr || argc < 3) return 2;
  std::string uris;
  for (int i = 2; i < argc; ++i) uris += "file://" + std::filesystem::absolute(argv[i]).string() + "\r\n";
  alarm(60);  // the window never answers
  const bool taken = DragSource(display, std::strtoul(argv[1], nullptr, 0), uris).drop();
  XCloseDisplay(display);
  return taken ? 0 : 1;
}
