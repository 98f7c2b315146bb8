// The three back ends behind Context::create(). Each returns a context that is initialised and current.
#pragma once

#include <memory>
#include <string>

#include "core/context/context.h"

namespace limn {

std::unique_ptr<Context> createEglContext(const ContextOptions& options);
std::unique_ptr<Context> createOsmesaContext(const ContextOptions& options);
std::unique_ptr<Context> createGlfwContext(const ContextOptions& options);

/// What the process has too little of for a driver to be loaded, memory or open files, and what would do;
/// empty where neither is short. Drivers themselves only say that they cannot be loaded.
std::string driverShortage();

/// Number of EGL devices (EGL_EXT_device_enumeration); 0 where there is no EGL driver.
int eglDeviceCount();

}  // namespace limn
