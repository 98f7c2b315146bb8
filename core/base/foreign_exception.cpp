#include "core/base/foreign_exception.h"

#include <algorithm>
#include <new>

#include "core/base/error.h"

namespace limn {

void rethrowAsError(const std::string& who) {
  std::string what;
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    what = "out of memory";
  } catch (const std::exception& exception) {
    what = exception.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
  } catch (...) {
    what = "it threw something that is no std::exception";
  }
  throw Error(who + ": " + what);
}

}  // namespace limn
