//! Elastomers by name, with the publication of each number.
//!
//! ```text
//! Yeoh           W = C1 (I1 - 3) + C2 (I1 - 3)^2 + C3 (I1 - 3)^3      mu = 2 C1
//! Mooney-Rivlin  W = C10 (I1 - 3) + C01 (I2 - 3)                      mu = 2 (C10 + C01)
//! neo-Hookean    W = mu/2 (I1 - 3)
//! E = 2 (1 + nu) mu
//! ```
//!
//! The sources assume incompressibility. A section uses the ratio [INCOMPRESSIBLE]; silicones with a bulk modulus above
//! 1 GPa have ratios closer to 0.5. Batch, curing, strain rate and previous stretches change a modulus by some ten
//! percent. Measured numbers next to a name take precedence.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::finite::law::Law;
use crate::input::Material;

/// Poisson's ratio of materials that a source calls incompressible: the largest without loss of accuracy in a section.
pub const INCOMPRESSIBLE: f64 = 0.4999;

/// A law with its published constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Published {
    /// Young's modulus at small strain [Pa] of an incompressible solid, without a law for large strain.
    Small(f64),
    /// Shear modulus mu of the neo-Hookean law [Pa].
    NeoHookean(f64),
    /// C10, C01 [Pa].
    MooneyRivlin(f64, f64),
    /// C1, C2, C3 [Pa].
    Yeoh(f64, f64, f64),
}

impl Published {
    /// Shear modulus at small strain [Pa].
    pub fn shear_modulus(self) -> f64 {
        match self {
            Self::Small(young) => young / (2.0 * (1.0 + INCOMPRESSIBLE)),
            Self::NeoHookean(mu) => mu,
            Self::MooneyRivlin(c10, c01) => 2.0 * (c10 + c01),
            Self::Yeoh(c1, ..) => 2.0 * c1,
        }
    }

    /// Law at finite strain, without the shear modulus; None if no law was found.
    pub fn law(self) -> Option<Law> {
        Some(match self {
            Self::Small(_) => return None,
            Self::NeoHookean(_) => Law::NeoHookean,
            Self::MooneyRivlin(c10, c01) => Law::MooneyRivlin {
                second: c01 / (c10 + c01),
            },
            Self::Yeoh(c1, c2, c3) => Law::Yeoh {
                second: c2 / c1,
                third: c3 / c1,
            },
        })
    }
}

/// Properties of an elastomer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastomer {
    /// Elastic law.
    pub published: Published,
    /// Largest stretch covered by the source or the fit to its data.
    pub up_to_stretch: Option<f64>,
    /// Source of the elastic law.
    pub elastic_source: &'static str,
    /// Density [kg/m^3].
    pub density_kg_m3: f64,
    /// Source of the density.
    pub density_source: &'static str,
}

macro_rules! presets {
    ($($(#[doc = $what:literal])+ $name:ident = $key:literal: $published:expr, $stretch:expr, $elastic:expr; $density:literal, $weighed:expr;)*) => {
        /// Elastomers by name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        #[schemars(rename = "MaterialPreset")]
        pub enum Preset {
            $($(#[doc = $what])+ #[serde(rename = $key)] $name,)*
        }

        impl Preset {
            /// All presets.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// Name in a section.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$name => $key,)*
                }
            }

            /// Properties of the elastomer.
            pub fn elastomer(self) -> Elastomer {
                match self {
                    $(Self::$name => Elastomer {
                        published: $published,
                        up_to_stretch: $stretch,
                        elastic_source: $elastic,
                        density_kg_m3: $density,
                        density_source: $weighed,
                    },)*
                }
            }
        }
    };
}

/// Tension test of dumbbells (ASTM D412, 450 mm/min, strain from the crosshead). The constants are a least-squares fit
/// to its data with equal weights; `tests/case/materials.rs` compares them with points of the data.
const MARECHAL: &str = "fit to the tension test in the Soft Robotics Materials Database, Marechal et al. 2021, Soft Robotics 8(3), doi:10.1089/soro.2019.0115";

presets! {
    /// Ecoflex 00-30 (Smooth-On), a platinum silicone of Shore 00-30: tension test in Marechal et al. 2021, doi:10.1089/soro.2019.0115.
    Ecoflex0030 = "ecoflex-00-30": Published::Yeoh(7733.5, 139.15, -4.0616), Some(3.0), MARECHAL;
        1070.0, "Smooth-On, technical bulletin Ecoflex Series (specific gravity 1.07)";
    /// Dragon Skin 10 (Smooth-On), a platinum silicone of Shore 10A: tension test in Marechal et al. 2021, doi:10.1089/soro.2019.0115.
    DragonSkin10 = "dragon-skin-10": Published::Yeoh(21590.0, 3044.3, -111.6), Some(3.0), MARECHAL;
        1070.0, "Smooth-On, technical bulletin Dragon Skin Series (specific gravity 1.07)";
    /// Dragon Skin 20 (Smooth-On), a platinum silicone of Shore 20A: tension test in Marechal et al. 2021, doi:10.1089/soro.2019.0115.
    DragonSkin20 = "dragon-skin-20": Published::Yeoh(63799.0, 7372.4, -287.25), Some(3.0), MARECHAL;
        1080.0, "Smooth-On, technical bulletin Dragon Skin Series (specific gravity 1.08)";
    /// Dragon Skin 30 (Smooth-On), a platinum silicone of Shore 30A: tension test in Marechal et al. 2021, doi:10.1089/soro.2019.0115.
    DragonSkin30 = "dragon-skin-30": Published::Yeoh(92175.0, 9028.4, -356.94), Some(3.0), MARECHAL;
        1080.0, "Smooth-On, technical bulletin Dragon Skin Series (specific gravity 1.08)";
    /// Elastosil M 4601 (Wacker), a platinum silicone of Shore 28A: Polygerinos et al. 2013, doi:10.1109/IROS.2013.6696549.
    ElastosilM4601 = "elastosil-m4601": Published::Yeoh(0.11e6, 0.02e6, 0.0), None,
        "Polygerinos et al. 2013, Towards a soft pneumatic glove for hand rehabilitation, IROS, doi:10.1109/IROS.2013.6696549";
        1130.0, "Wacker, data sheet Elastosil M 4601 A/B (1.13 g/cm3, ISO 2781)";
    /// PDMS: Sylgard 184 (Dow), base to agent 10:1, cured at 25 C (at 200 C 2.97 MPa): Johnston et al. 2014,
    /// doi:10.1088/0960-1317/24/3/035017.
    Pdms10 = "pdms-10-1": Published::Small(1.32e6), None,
        "Johnston et al. 2014, Mechanical characterization of bulk Sylgard 184, J. Micromech. Microeng. 24, 035017, doi:10.1088/0960-1317/24/3/035017";
        1030.0, "Dow Corning, product information Sylgard 184, form 11-3184B (specific gravity cured 1.03)";
    /// TPU of Shore 85A: NinjaFlex (NinjaTek), tensile modulus of printed bars by ASTM D638: NinjaTek, technical specifications NinjaFlex.
    Tpu85a = "tpu-85a": Published::Small(12e6), None,
        "NinjaTek, technical specifications NinjaFlex 3D Printing Filament (tensile modulus 12 MPa, ASTM D638)";
        1190.0, "NinjaTek, technical specifications NinjaFlex 3D Printing Filament (specific gravity 1.19, ASTM D792)";
    /// Natural rubber, vulcanised without filler: Treloar 1944, doi:10.1039/TF9444000059, whose data neo-Hooke's law
    /// follows up to stretch 1.5.
    NaturalRubber = "natural-rubber": Published::NeoHookean(0.39e6), Some(1.5),
        "Treloar 1944, Stress-strain data for vulcanised rubber under various types of deformation, Trans. Faraday Soc. 40, 59-70, doi:10.1039/TF9444000059";
        950.0, "MatWeb, Natural Rubber, Vulcanized (0.950 g/cm3, uncompounded)";
}

impl Preset {
    /// The material at small strain.
    pub fn material(self) -> Material {
        let elastomer = self.elastomer();
        Material {
            young_modulus_pa: 2.0 * (1.0 + INCOMPRESSIBLE) * elastomer.published.shear_modulus(),
            poisson_ratio: INCOMPRESSIBLE,
            density_kg_m3: elastomer.density_kg_m3,
            law: elastomer.published.law(),
        }
    }
}

/// A law as it is written.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[schemars(rename = "Law")]
enum GivenLaw {
    /// None, whatever a preset has: small strains.
    Linear,
    /// Treloar's.
    NeoHookean,
    /// Mooney's and Rivlin's.
    MooneyRivlin {
        /// Part of the shear modulus in the second invariant, C01/(C10 + C01).
        #[schemars(range(min = 0.0, max = 1.0))]
        second: f64,
    },
    /// Yeoh's.
    Yeoh {
        /// C2/C1.
        second: f64,
        /// C3/C1.
        third: f64,
    },
    /// Linear between the second Piola-Kirchhoff stress and Green's strain, the law of the paper's finite elements.
    SaintVenantKirchhoff,
}

impl GivenLaw {
    fn law(self) -> Option<Law> {
        Some(match self {
            Self::Linear => return None,
            Self::NeoHookean => Law::NeoHookean,
            Self::MooneyRivlin { second } => Law::MooneyRivlin { second },
            Self::Yeoh { second, third } => Law::Yeoh { second, third },
            Self::SaintVenantKirchhoff => Law::SaintVenantKirchhoff,
        })
    }
}

/// A material as it is written: by its numbers, or by a name with the numbers that differ beside it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Material", extend(
    "if" = {"required": ["preset"]},
    "else" = {"required": ["young_modulus_pa", "poisson_ratio", "density_kg_m3"]}
))]
pub(crate) struct Given {
    /// An elastomer by name: what is not given beside it is taken from there. docs/materials.md has all numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    preset: Option<Preset>,
    /// Young's modulus E [Pa], above 0.
    young_modulus_pa: Option<f64>,
    /// Poisson's ratio nu, above -1 and below 0.5.
    poisson_ratio: Option<f64>,
    /// Density [kg/m^3].
    density_kg_m3: Option<f64>,
    /// Law at finite strain: with it the section has an energy beyond its quadratic part. Absent: that of the preset; without either the
    /// material is linear, but for that of a region, which is neo-Hookean beside one that is not.
    law: Option<GivenLaw>,
}

impl TryFrom<Given> for Material {
    type Error = String;

    fn try_from(given: Given) -> Result<Self, String> {
        let named = given.preset.map(Preset::material);
        let number = |key: &str, own: Option<f64>, of: fn(&Material) -> f64| {
            own.or(named.as_ref().map(of))
                .ok_or_else(|| format!("the key \"{key}\" is missing; a \"preset\" supplies it"))
        };
        Ok(Self {
            young_modulus_pa: number("young_modulus_pa", given.young_modulus_pa, |m| m.young_modulus_pa)?,
            poisson_ratio: number("poisson_ratio", given.poisson_ratio, |m| m.poisson_ratio)?,
            density_kg_m3: number("density_kg_m3", given.density_kg_m3, |m| m.density_kg_m3)?,
            law: given.law.map_or(named.and_then(|m| m.law), GivenLaw::law),
        })
    }
}
