# Third-party libraries. scripts/packages.txt names the Debian packages they come from.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(draco REQUIRED)
find_package(OpenImageIO REQUIRED)
find_package(embree 3 REQUIRED)
find_package(TBB REQUIRED)
find_package(glfw3 3.3 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(KISSFFT REQUIRED IMPORTED_TARGET kissfft-float)
find_library(LIMN_EGL_LIBRARY EGL REQUIRED)
# Debian's OpenVDB has no CMake package of its own.
find_path(LIMN_OPENVDB_INCLUDE openvdb/openvdb.h REQUIRED)
find_library(LIMN_OPENVDB_LIBRARY openvdb REQUIRED)
find_package(Imath REQUIRED)  # whose numbers it holds
# Its templates' static members must be one with the library's own: hidden, they crash it.
set(LIMN_OPENVDB_OPTIONS -fvisibility=default -fno-visibility-inlines-hidden)
find_program(LIMN_HELP2MAN help2man REQUIRED)
# The report page: D3's modules, and the bundler that joins them.
find_program(LIMN_ESBUILD esbuild REQUIRED)
find_path(LIMN_NODE_MODULES d3-scale/package.json PATHS /usr/share/nodejs REQUIRED)

# How meshoptimizer was built is nothing that those who use it need on every command line.
set_target_properties(meshoptimizer::meshoptimizer PROPERTIES INTERFACE_COMPILE_DEFINITIONS "")
# Debian's OpenImageIO target names opencv's include folder, which limn does not need and may not exist.
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")
