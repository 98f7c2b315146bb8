// The three back ends behind Context::create(). Each returns a context that is initialised and current.
#pragma once

#include <memory>

#include "core/context/context.h"

namespace limn {

std::unique_ptr<Context> createEglContext(const ContextOptions& options);
std::unique_ptr<Context> createOsmesaContext(const ContextOptions& options);
std::unique_ptr<Context> createGlfwContext(const ContextOptions& options);

/// Number of EGL devices (EGL_EXT_device_enumeration); 0 where there is no EGL driver.
int eglDeviceCount();

}  // namespace limn
