#include "core/image/compare_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace limn {

std::string metricsJson(const Metrics& metrics) {
  // The library writes values that are not finite as null.
  nlohmann::ordered_json json = {{"rmse", metrics.rmse},
                                 {"rel_mse", metrics.rel_mse},
                                 {"bias", metrics.bias},
                                 {"p999", metrics.p999},
                                 {"psnr", metrics.psnr},
                                 {"flip", metrics.flip},
                                 {"structured", metrics.structured},
                                 {"masked_share", metrics.masked_share},
                                 {"pixels", metrics.pixels}};
  if (metrics.noise_floor) json["noise_floor"] = *metrics.noise_floor;
  return json.dump(2) + "\n";
}

std::string metricsTable(const Metrics& metrics) {
  std::string text;
  const auto line = [&](const char* name, double value, const char* meaning) {
    text += fmt::format("{:<13} {:>12.6g}  {}\n", name, value, meaning);
  };
  line("RMSE", metrics.rmse, "root mean square error, linear");
  line("relative MSE", metrics.rel_mse, "squared error relative to the squared reference");
  line("bias", metrics.bias, "mean signed error; positive: too bright");
  line("p99.9", metrics.p999, "99.9th percentile of the error in luminance");
  line("PSNR", metrics.psnr, "dB, relative to the 99.9th percentile of the reference");
  line("FLIP", metrics.flip, "mean perceived difference, 0 to 1");
  line("structured", metrics.structured, "root mean square of the smoothed error (banding, not noise)");
  text +=
      fmt::format("{} pixels compared; {:.3f} % of the covered ones differ in coverage, instance or depth\n",
                  metrics.pixels, 100 * metrics.masked_share);
  if (metrics.noise_floor) {
    text += fmt::format("noise floor of the reference {:.6g}: {}\n", *metrics.noise_floor,
                        metrics.rmse < *metrics.noise_floor ? "the difference is within it" : "exceeded");
  }
  return text;
}

}  // namespace limn
