#include "base_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace thawslide::testing_support {

namespace {

constexpr const char* without_heat_and_water =
    "mechanisms.pressurization=false; heat.enabled=false; pressure.enabled=false";

// A function, because tests ask for texts before main().
const std::map<std::string, Sets>& all_bases() {
  static const std::map<std::string, Sets> bases{
      {"block",
       without_heat_and_water +
           Sets("time.end=1.0; time.step=0.001; grid.cell=5.0; grid.min=[-20.0, -10.0]; grid.max=[200.0, 40.0]; "
                "terrain.type='flat'; material.rock.law='elastic'; material.rock.youngs_modulus=5e8; "
                "material.rock.poisson_ratio=0.2; material.rock.viscosity_time=0.02; body.block.material='rock'; "
                "body.block.min=[0.0, 0.0]; body.block.max=[40.0, 20.0]; basal.friction='constant'; "
                "basal.friction_angle=20.0")},
      {"free",
       "case.gravity=0.0; time.end=1.0; time.step=0.002; grid.cell=1.0; grid.min=[0.0, 0.0]; grid.max=[40.0, 40.0]; "
       "material.rock.law='elastic'; material.rock.youngs_modulus=1e8; material.rock.poisson_ratio=0.25; "
       "material.rock.viscosity_time=0; "
       "body.block.material='rock'; body.block.min=[17.3, 17.6]; body.block.max=[22.3, 22.6]; "
       "mechanics.initial_stress='none'; heat.enabled=false; pressure.enabled=false"},
      {"slab",
       "time.end=2.0; time.step=0.002; grid.cell=10.0; grid.min=[-50.0, -10.0]; grid.max=[500.0, 80.0]; "
       "terrain.type='flat'; material.rock.law='elastic'; material.rock.youngs_modulus=1e9; "
       "material.rock.poisson_ratio=0.2; material.rock.viscosity_time=0.02; material.rock.hydraulic_conductivity=2e-8; "
       "body.slab.material='rock'; body.slab.min=[0.0, 0.0]; body.slab.max=[200.0, 50.0]; basal.friction='lubricated'; "
       "basal.friction_angle=25.0; band.thickness=0.05"},
      // 200 m long, 40 m thick, on 30 degrees, with an initial velocity of 8 m/s.
      {"columns",
       "case.gravity_tilt=30.0; time.end=6.0; time.step=0.005; grid.cell=10.0; grid.min=[-60.0, -20.0]; "
       "grid.max=[600.0, 80.0]; terrain.type='flat'; phases.water_expansion_law='by_temperature'; "
       "material.rock.law='elastic'; material.rock.youngs_modulus=2e8; material.rock.poisson_ratio=0.2; "
       "material.rock.viscosity_time=0.02; material.rock.hydraulic_conductivity=1e-7; body.slab.material='rock'; "
       "body.slab.min=[0.0, 0.0]; body.slab.max=[200.0, 40.0]; body.slab.temperature=-1.0; body.slab.porosity=0.375; "
       "body.slab.velocity=[8.0, 0.0]; basal.friction='lubricated'; basal.friction_angle=32.0; basal.cohesion=0.0; "
       "basal.heat_fraction=0.9; band.model='columns'; band.thickness=0.1; band.thickness_change='conserving'; "
       "pressure.frozen='none'; pressure.frozen_rows='sealed'; pressure.melt_contraction=true; "
       "pressure.skeleton_compressibility=2e-9"},
      {"bar",
       "case.gravity=0.0; time.end=4.0e5; time.step=1000.0; grid.cell=0.1; grid.min=[0.0, 0.0]; grid.max=[4.0, 0.4]; "
       "material.bar.law='elastic'; material.bar.youngs_modulus=1e7; material.bar.poisson_ratio=0.3; "
       "body.bar.material='bar'; body.bar.min=[0.0, 0.0]; body.bar.max=[4.0, 0.4]; body.bar.temperature=2.0; "
       "mechanics.enabled=false; pressure.enabled=false"},
      {"column",
       "time.end=100.0; time.step=0.05; grid.cell=0.5; grid.min=[0.0, 0.0]; grid.max=[1.0, 12.0]; "
       "material.soil.law='elastic'; material.soil.youngs_modulus=1e8; material.soil.poisson_ratio=0.2; "
       "material.soil.hydraulic_conductivity=1e-7; body.column.material='soil'; body.column.min=[0.0, 0.0]; "
       "body.column.max=[1.0, 10.0]; body.column.temperature=5.0; mechanics.enabled=false"},
      // Sand with an angle of repose of 31 degrees slides along planes at tau = tan(31) sigma; without dilation such
      // planes resist sin(phi) sigma (Davis 1968): phi = asin(tan(31)) = 36.9 degrees.
      {"sand",
       without_heat_and_water +
           Sets(
               "time.end=6.0; time.step=0.0035; grid.cell=0.625; grid.min=[0.0, -2.5]; grid.max=[140.0, 60.0]; "
               "grid.boundary.x_min='roller'; terrain.type='flat'; material.sand.law='mohr_coulomb'; "
               "material.sand.youngs_modulus=2e7; material.sand.poisson_ratio=0.3; material.sand.friction_angle=36.93; "
               "material.sand.cohesion=0.0; material.sand.gaps_close_first=true; material.sand.viscosity_time=0; "
               "body.column.material='sand'; "
               "body.column.min=[0.0, 0.0]; body.column.max=[10.0, 10.0]; basal.friction='constant'; "
               "basal.friction_angle=31.0")},
      {"release",
       without_heat_and_water +
           Sets("case.dimension=3; time.end=5.0; time.step=0.002; grid.cell=5.0; grid.min=[-100.0, -100.0, -200.0]; "
                "grid.max=[100.0, 100.0, 200.0]; terrain.type='dem'; terrain.file='dem.tif'; "
                "material.debris.law='mohr_coulomb'; material.debris.youngs_modulus=2e7; "
                "material.debris.poisson_ratio=0.3; material.debris.friction_angle=30.0; material.debris.cohesion=0.0; "
                "material.debris.gaps_close_first=true; material.debris.viscosity_time=0; "
                "body.slide.material='debris'; body.slide.shape='release'; "
                "body.slide.thickness={ raster = 'thickness.tif' }; basal.friction='constant'; "
                "basal.friction_angle=15.0")},
      {"profile",
       without_heat_and_water +
           Sets("time.end=30.0; time.step=0.001; grid.cell=2.5; grid.min=[-340.0, -10.0]; grid.max=[190.0, 200.0]; "
                "terrain.type='profile'; terrain.file='profile.csv'; material.rock.law='elastic'; "
                "material.rock.youngs_modulus=5e8; material.rock.poisson_ratio=0.2; material.rock.viscosity_time=0.01; "
                "body.slide.material='rock'; body.slide.shape='surface'; mechanics.slope_shear=true; "
                "basal.friction='constant'; basal.friction_angle=10.0")},
      {"two_bodies",
       "case.gravity_tilt=35.0; time.end=10.0; time.step=0.002; grid.cell=1.0; grid.min=[-4.0, -4.0]; "
       "grid.max=[40.0, 20.0]; terrain.type='flat'; material.frozen.law='mohr_coulomb'; "
       "material.frozen.youngs_modulus=2e8; material.frozen.poisson_ratio=0.3; material.frozen.friction_angle=35.0; "
       "material.frozen.cohesion=0.0; material.frozen.viscosity_time=0; material.frozen.hydraulic_conductivity=1e-9; "
       "material.melted.law='mohr_coulomb'; "
       "material.melted.youngs_modulus=1e8; material.melted.poisson_ratio=0.2; material.melted.friction_angle=30.0; "
       "material.melted.cohesion=0.0; material.melted.viscosity_time=0; material.melted.residual_cohesion=0.0; "
       "material.melted.softening_strain=1.0; "
       "material.melted.tension_cutoff=1e5; material.melted.hydraulic_conductivity=1e-10; body.left.material='frozen'; "
       "body.left.min=[0.0, 0.0]; body.left.max=[7.0, 5.0]; body.left.temperature=-0.5; body.left.porosity=0.375; "
       "body.right.material='melted'; body.right.min=[7.0, 0.0]; body.right.max=[11.3, 4.1]; "
       "body.right.temperature=1.5; body.right.porosity=0.3; body.right.particles_per_axis=3; "
       "basal.friction='lubricated'; basal.friction_angle=25.0; band.thickness=0.1"},
      {"box",
       "case.dimension=3; case.gravity_tilt=25.0; time.end=10.0; time.step=0.002; grid.cell=1.0; "
       "grid.min=[-4.0, -5.0, -3.0]; grid.max=[60.0, 15.0, 20.0]; terrain.type='flat'; "
       "material.rock.law='mohr_coulomb'; "
       "material.rock.youngs_modulus=1e7; material.rock.poisson_ratio=0.3; material.rock.friction_angle=20.0; "
       "material.rock.cohesion=0.0; material.rock.hydraulic_conductivity=1e-9; body.box.material='rock'; "
       "body.box.min=[0.0, 3.0, 0.0]; body.box.max=[6.0, 7.0, 3.0]; body.box.temperature=-0.5; "
       "body.box.porosity=0.375; "
       "basal.friction='lubricated'; basal.friction_angle=5.0; band.thickness=0.1"}};
  return bases;
}

std::string key_of(const std::string& set) { return set.substr(0, set.find('=')); }

// Base case as a text, and sets, without removed keys.
std::pair<std::string, Sets> resolved(const std::string& name, const Sets& sets) {
  Sets base = all_bases().at(name), kept;
  for (const std::string& set : sets) {
    if (set.back() == '=') {
      const auto is_removed = [&](const std::string& other) { return key_of(other) == key_of(set); };
      base.erase(std::remove_if(base.begin(), base.end(), is_removed), base.end());
      kept.erase(std::remove_if(kept.begin(), kept.end(), is_removed), kept.end());
    } else {
      kept.push_back(set);
    }
  }
  return {fmt::format("{}\n", fmt::join(base, "\n")), kept};
}

}  // namespace

Sets::Sets(const std::string& text) {
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    const std::size_t begin = part.find_first_not_of(" \n");
    if (begin != std::string::npos) {
      push_back(part.substr(begin));
    }
  }
}

Sets::Sets(std::initializer_list<std::string> texts) : Sets(std::vector<std::string>(texts)) {}

Sets::Sets(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const Sets parts(text);
    insert(end(), parts.begin(), parts.end());
  }
}

const std::string& base_text(const std::string& name) {
  static std::map<std::string, std::string> texts;
  return texts.try_emplace(name, fmt::format("{}\n", fmt::join(all_bases().at(name), "\n"))).first->second;
}

config::Case case_from_text(const Variant& variant, const Sets& sets) {
  const auto [text, kept] = resolved(variant.base, variant.sets + sets);
  return case_from_text(text, kept);
}

config::Case paper_case(const Variant& variant, const Sets& sets) {
  const auto [text, kept] = resolved(variant.base, variant.sets + sets);
  return paper_case(text, kept);
}

}  // namespace thawslide::testing_support
