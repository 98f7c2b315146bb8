// Models of materials as BRDFs, measured ones by the values of their tables.
#include "core/brdf/model_brdf.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/brdf/measured_model.h"
#include "core/brdf/merl_file.h"
#include "tests/unit/materials/models.h"

namespace limn::brdf {
namespace {

/// Appends the values of a table, and returns its model.
template <class Table>
glsl::MaterialModel appended(const Table& table, std::vector<glm::vec3>& measured) {
  glsl::MaterialModel model = measuredModel(table).model;
  model.table = static_cast<glsl::uint>(measured.size());
  measured.insert(measured.end(), table.values.begin(), table.values.end());
  return model;
}

TabulatedBrdf constantTable() {
  return tabulate({3, 4, 5}, [](const glm::vec3&, const glm::vec3&) { return glm::vec3(0.2f, 0.1f, 0); });
}

TEST(ModelBrdf, IsTheResponseWithoutTheCosine) {
  std::vector<glm::vec3> measured(7, glm::vec3(9));
  const glm::dvec3 l(0.6, 0, 0.8), v(0, -0.6, 0.8);
  const Brdf phong = modelBrdf(glsl::phongModel(0.3f, 0, 10), measured);
  EXPECT_NEAR(phong(l, v).x, 0.3 * std::numbers::inv_pi, 1e-7);
  const Brdf table = modelBrdf(appended(constantTable(), measured), measured);
  EXPECT_NEAR(table(l, v).x, 0.2, 1e-7);
  EXPECT_NEAR(table(l, v).y, 0.1, 1e-7);
}

TEST(ModelBrdf, MeasuredModelsAreTheSameByTheirValues) {
  std::vector<glm::vec3> measured(7, glm::vec3(9));
  TabulatedBrdf table = constantTable();
  const glsl::MaterialModel one = appended(table, measured), again = appended(table, measured);
  EXPECT_NE(one.table, again.table);
  EXPECT_TRUE(sameModel(one, one, measured));
  EXPECT_TRUE(sameModel(one, again, measured));
  glsl::MaterialModel darker = again;
  darker.ks *= 0.5f;
  EXPECT_FALSE(sameModel(one, darker, measured));

  // One value of a table whose other numbers are equal.
  glsl::MaterialModel other = one;
  table.values.back().z += 1e-3f;
  other.table = appended(table, measured).table;
  EXPECT_FALSE(sameModel(one, other, measured));
  // The first and the last value of tables over two directions.
  for (const size_t changed : {size_t{0}, size_t{15}}) {
    AnisotropicTable pairs{.size = 2, .values = std::vector<glm::vec3>(16, glm::vec3(0.1f))};
    const glsl::MaterialModel plain = appended(pairs, measured), equal = appended(pairs, measured);
    EXPECT_TRUE(sameModel(plain, equal, measured));
    pairs.values[changed].x = 0.2f;
    glsl::MaterialModel different = plain;
    different.table = appended(pairs, measured).table;
    EXPECT_FALSE(sameModel(plain, different, measured)) << changed;
  }
}

TEST(ModelBrdf, OtherModelsAreTheSameByTheirNumbers) {
  const std::vector<glm::vec3> none;
  const glsl::MaterialModel phong = glsl::phongModel(0.3f, 0.2f, 10);
  EXPECT_TRUE(sameModel(phong, glsl::phongModel(0.3f, 0.2f, 10), none));
  EXPECT_FALSE(sameModel(phong, glsl::phongModel(0.3f, 0.2f, 11), none));
  EXPECT_FALSE(sameModel(phong, glsl::phongModel(0.3f, 0.1f, 10), none));
  EXPECT_FALSE(sameModel(phong, glsl::banksModel(0.3f, 0.2f, 10), none));
}

/// Of the same model and settings there is one, whatever its material is called and wherever its table lies.
TEST(ModelFit, IsMadeOnceForEachModelAndSettings) {
  const FitSettings settings{.factorisation = Factorisation::trilinear, .texels = 4, .samples = 200};
  std::vector<glm::vec3> measured(7, glm::vec3(9));
  TabulatedBrdf table = constantTable();
  const glsl::MaterialModel phong = glsl::phongModel(0.3f, 0.2f, 10), one = appended(table, measured);
  const auto ofPhong = fitModel(phong, measured, settings), ofTable = fitModel(one, measured, settings);
  EXPECT_NE(ofTable, ofPhong);
  const FactoredBrdf plain = fitBrdf(modelBrdf(phong, measured), settings);
  EXPECT_EQ(ofPhong->name, plain.name);
  EXPECT_EQ(ofPhong->error, plain.error);
  ASSERT_EQ(ofPhong->tables.size(), plain.tables.size());
  EXPECT_EQ(ofPhong->tables.front().texels, plain.tables.front().texels);

  glsl::MaterialModel other = phong;
  other.material = 5;
  EXPECT_EQ(fitModel(other, {}, settings), ofPhong);
  std::vector<glm::vec3> elsewhere(11, glm::vec3(9));
  EXPECT_EQ(fitModel(appended(table, elsewhere), elsewhere, settings), ofTable);

  other.exponent = 11;
  EXPECT_NE(fitModel(other, {}, settings), ofPhong);
  FitSettings finer = settings;
  finer.texels = 6;
  EXPECT_NE(fitModel(phong, {}, finer), ofPhong);
  table.values.back().z += 1e-3f;
  EXPECT_NE(fitModel(appended(table, elsewhere), elsewhere, settings), ofTable);
  EXPECT_EQ(fitModel(phong, {}, settings), ofPhong) << "it is still there";
}

/// Tables are known by their hash and take nothing of the memory for fits, which five of MERL's would exceed.
TEST(ModelFit, IsKeptHoweverLargeTheTableIs) {
  const FitSettings settings{.factorisation = Factorisation::trilinear, .texels = 4, .samples = 200};
  constexpr size_t nodes = size_t{kMerlSize.x} * size_t{kMerlSize.y} * size_t{kMerlSize.z};
  std::vector<glm::vec3> measured;
  measured.reserve(5 * nodes);
  std::vector<glsl::MaterialModel> models;
  std::vector<std::shared_ptr<const FactoredBrdf>> fits;
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 f(0.1f + 0.02f * static_cast<float>(i));
    models.push_back(
        appended(TabulatedBrdf{.size = kMerlSize, .values = std::vector<glm::vec3>(nodes, f)}, measured));
    fits.push_back(fitModel(models.back(), measured, settings));
  }
  for (size_t i = 0; i < models.size(); ++i) EXPECT_EQ(fitModel(models[i], measured, settings), fits[i]) << i;
}

/// Each has the fit that it has alone, and what cannot be fitted has none.
TEST(ModelFit, OfSeveralModelsIsThatOfEach) {
  for (const Factorisation factorisation : {Factorisation::dfg, Factorisation::svd}) {
    const FitSettings settings{.factorisation = factorisation, .texels = 4, .samples = 200};
    const std::vector<glsl::MaterialModel> models{
        glsl::phongModel(0.3f, 0.25f, 10), glsl::phongModel(0, 0, 10), glsl::phongModel(0.3f, 0.25f, 20)};
    const auto fits = fitModels(models, {}, settings);
    ASSERT_EQ(fits.size(), 3u);
    EXPECT_EQ(fits[0], fitModel(models[0], {}, settings));
    EXPECT_EQ(fits[1], nullptr);
    EXPECT_EQ(fits[2], fitModel(models[2], {}, settings));
    EXPECT_NE(fits[0], fits[2]);
    const std::vector<glm::vec3> none;
    const FactoredBrdf alone = fitBrdf(modelBrdf(models[2], none), settings);
    EXPECT_EQ(fits[2]->error, alone.error);
    EXPECT_EQ(fits[2]->tables.front().texels, alone.tables.front().texels);
  }
  const std::vector<glsl::MaterialModel> one{glsl::phongModel(0.3f, 0.25f, 10)};
  EXPECT_THROW(fitModels(one, {}, {.texels = 1}), UsageError);
  EXPECT_TRUE(fitModels({}, {}, {}).empty());
}

/// What throws is asked again, and throws again.
TEST(ModelFit, BlackModelsHaveNone) {
  const glsl::MaterialModel black = glsl::phongModel(0, 0, 10);
  for (int i = 0; i < 2; ++i)
    EXPECT_THROW(fitModel(black, {}, {.factorisation = Factorisation::trilinear, .texels = 4}), Error);
}

}  // namespace
}  // namespace limn::brdf
