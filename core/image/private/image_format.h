// Declares what is known of a picture file before a decoder is given it: its format, and damage that decoders
// overlook.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace limn {

/// Names the formats that OpenImageIO decodes.
enum class ImageFormat { exr, hdr, png, jpeg };

/// Returns the format by content, not by name: a wrong extension must not choose a decoder for foreign bytes.
/// Throws Error with one line that begins with `name` for any other content.
ImageFormat detectImageFormat(std::span<const std::byte> bytes, const std::string& name);

/// Returns an empty string, or what a decoder should not be given the file for.
std::string imageFileProblem(std::span<const std::byte> bytes, ImageFormat format);

}  // namespace limn
