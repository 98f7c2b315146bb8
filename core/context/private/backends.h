// Declares the three back ends of Context::create(). Each returns a context that is initialised and current.
#pragma once

#include <memory>
#include <string>

#include "core/context/context.h"

namespace limn {

std::unique_ptr<Context> createEglContext(const ContextOptions& options);
std::unique_ptr<Context> createOsmesaContext(const ContextOptions& options);
std::unique_ptr<Context> createGlfwContext(const ContextOptions& options);

/// Returns a description of what the process lacks to load a driver, memory or open files, and how much would
/// suffice; empty where there is enough of both. Drivers themselves report only that they cannot be loaded.
std::string driverShortage();

/// Returns the number of EGL devices (EGL_EXT_device_enumeration); 0 without an EGL driver.
int eglDeviceCount();

}  // namespace limn
