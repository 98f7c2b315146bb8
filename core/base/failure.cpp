#include "core/base/failure.h"

#include <algorithm>
#include <exception>
#include <new>

namespace limn {

std::string currentFailure() {
  std::string message;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    message = "out of memory";
  } catch (const std::exception& error) {
    message = error.what();
  } catch (...) {
    message = "something was thrown that is no std::exception";
  }
  std::ranges::replace(message, '\n', ' ');
  return message.empty() ? "a failure without a message" : message;
}

}  // namespace limn
