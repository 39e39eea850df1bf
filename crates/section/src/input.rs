//! Input of a section: one unit cell in the plane of the beam's axis and height.
//!
//! The cell is `pitch_m` long and `height_m` high. Its origin is on the mid-plane in the middle of the pitch. Points
//! are `[along, high]`: `along` is the direction of the beam's axis z, `high` that of the transverse axis x, towards
//! the upper row.

use crate::finite::Law;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use crate::materials::Given;

/// A point `[along, high]` of the cell's plane [m].
pub type Point = [f64; 2];

/// The unit cell of a beam with bladders.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Height of the beam, h_s [m].
    pub height_m: f64,
    /// Width of the beam, w_s [m].
    pub width_m: f64,
    /// Distance between neighbouring bladders of a row [m], 1/phi_b.
    pub pitch_m: f64,
    /// Material of the beam outside the regions.
    pub material: Material,
    /// The two rows of bladders. Without bladders: `{"length_m": 0.01, "upper": "none", "lower": "none"}`, in which the length has no effect.
    pub bladders: Bladders,
    /// Parts of the cell made of another material: a skin, a stiff sheet, a fibre. None may overlap another or cross a bladder's wall.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<Region>,
    /// Solves the cell in three dimensions, with the ends of bladders and side walls that bend: a second or
    /// more instead of a tenth.
    #[serde(default)]
    pub three_d: bool,
}

/// An isotropic elastic material; a case may give one of [crate::materials] by name.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Given")]
pub struct Material {
    /// Young's modulus E [Pa], above 0.
    pub young_modulus_pa: f64,
    /// Poisson's ratio nu, above -1 and below 0.5.
    pub poisson_ratio: f64,
    /// Density [kg/m^3].
    pub density_kg_m3: f64,
    /// Law at finite strain; absent: none for the section's material, which is then linear, and neo-Hookean for that of a region.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<Law>,
}

impl Material {
    /// Shear modulus mu = E / 2(1 + nu) [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.young_modulus_pa / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// Bulk modulus K = E / 3(1 - 2 nu) [Pa].
    pub fn bulk_modulus(&self) -> f64 {
        self.young_modulus_pa / (3.0 * (1.0 - 2.0 * self.poisson_ratio))
    }
}

/// The two rows of bladders: prisms across the beam's width, sealed at both ends by the side walls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SectionBladders")]
pub struct Bladders {
    /// Length across the width, l_b [m], at most the beam's width.
    pub length_m: f64,
    /// The row on the +x side.
    pub upper: Row,
    /// The row on the -x side.
    pub lower: Row,
}

impl Bladders {
    /// Length of a bladder along the beam [m]; 0 without bladders.
    pub fn along(&self) -> f64 {
        let row = [&self.upper, &self.lower].into_iter().find_map(|row| match row {
            Row::Bladder(bladder) => Some(bladder),
            Row::None | Row::Mirrored => None,
        });
        row.map_or(0.0, |bladder| match &bladder.shape {
            Shape::Circle { radius_m } => 2.0 * radius_m,
            Shape::Ellipse { along_m, .. } | Shape::RoundedRectangle { along_m, .. } => *along_m,
            Shape::Polygon { points_m } => {
                let along = || points_m.iter().map(|[along, _]| *along);
                along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
            }
        })
    }
}

/// One row: a bladder in every pitch, none, or (lower only) the upper one mirrored at the mid-plane.
#[derive(Debug, Clone, PartialEq)]
pub enum Row {
    /// No bladders.
    None,
    /// The upper row mirrored at the mid-plane.
    Mirrored,
    /// A bladder of its own.
    Bladder(Bladder),
}

/// A bladder's cross-section in the cell's plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SectionBladder")]
pub struct Bladder {
    /// Height of the shape's origin above the mid-plane [m].
    pub center_m: f64,
    /// Its shape.
    pub shape: Shape,
}

/// A closed shape about its own origin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A circle.
    Circle {
        /// Radius [m].
        radius_m: f64,
    },
    /// An ellipse with axes along the beam and through its height.
    Ellipse {
        /// Whole length along the beam [m].
        along_m: f64,
        /// Whole height [m].
        high_m: f64,
    },
    /// A rectangle, its corners rounded by quarter circles; `fillet_m` 0 leaves them sharp.
    RoundedRectangle {
        /// Length along the beam [m].
        along_m: f64,
        /// Height [m].
        high_m: f64,
        /// Radius of the corners [m], at most half of the shorter side.
        fillet_m: f64,
    },
    /// A polygon that does not cross itself, in either sense.
    Polygon {
        /// Corners `[along, high]` about the shape's origin [m].
        points_m: Vec<Point>,
    },
}

/// A part of the cell made of another material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Shape and place of the region.
    pub shape: RegionShape,
    /// Material of the region.
    pub material: Material,
}

/// The shape of a region, about the cell's origin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RegionShape {
    /// A layer through the whole pitch.
    Layer {
        /// From this height to that [m].
        high_m: [f64; 2],
    },
    /// A rectangle.
    Rectangle {
        /// From here to there along the beam [m].
        along_m: [f64; 2],
        /// From this height to that [m].
        high_m: [f64; 2],
    },
    /// A circle: a fibre across the width.
    Circle {
        /// Its centre `[along, high]` [m].
        center_m: Point,
        /// Its radius [m].
        radius_m: f64,
    },
    /// A polygon that does not cross itself, in either sense.
    Polygon {
        /// Corners `[along, high]` [m].
        points_m: Vec<Point>,
    },
}

impl JsonSchema for Material {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        Given::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Given::json_schema(generator)
    }
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Row::None => serializer.serialize_str("none"),
            Row::Mirrored => serializer.serialize_str("mirrored"),
            Row::Bladder(bladder) => bladder.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Row {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> de::Visitor<'de> for Visitor {
            type Value = Row;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a bladder {\"center_m\", \"shape\"}, \"none\", or for the lower row \"mirrored\"")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Row, E> {
                match text {
                    "none" => Ok(Row::None),
                    "mirrored" => Ok(Row::Mirrored),
                    _ => Err(E::unknown_variant(text, &["none", "mirrored"])),
                }
            }

            fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Row, A::Error> {
                Bladder::deserialize(de::value::MapAccessDeserializer::new(map)).map(Row::Bladder)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

impl JsonSchema for Row {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "SectionRow".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let bladder = generator.subschema_for::<Bladder>();
        json_schema!({ "oneOf": [
            { "type": "string", "enum": ["none"], "description": "No bladders." },
            { "type": "string", "enum": ["mirrored"], "description": "The upper row mirrored at the mid-plane; lower row only." },
            bladder
        ] })
    }
}
