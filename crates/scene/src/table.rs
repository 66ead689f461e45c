//! The keys of a model as one declarative table.
//!
//! A model describes its input once, as a `&'static [Key]`. Validation, defaults, `docs/keys.md`, the JSON schema of
//! the API and `tamp explain` all read this table, so they cannot disagree.

mod check;
mod document;
mod schema;

pub(crate) use check::{check_object, check_value, join, unknown_name};
pub use document::document;
pub(crate) use schema::object_schema;

/// One key of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Name in scene files; the paper's symbol in ASCII.
    pub name: &'static str,
    /// Unit: `Pa`, `m`, `tau`, …; `1` for pure numbers, `-` where a unit makes no sense.
    pub unit: &'static str,
    /// Which values are admitted.
    pub domain: Domain,
    /// What an absent key means.
    pub absent: Absent,
    /// What the key is, in a sentence without final stop.
    pub meaning: &'static str,
    /// Where it comes from: paper and equation, or why it exists.
    pub source: &'static str,
}

/// What an absent key means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absent {
    /// The key must be given.
    Required,
    /// The default as JSON text.
    Default(&'static str),
    /// The value of another key of the same table that stands before this one.
    SameAs(&'static str),
}

/// Which values a key admits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// A finite real number.
    Real(Bound, Bound),
    /// A whole number from the first to the second, both included; at most [`LARGEST_INTEGER`].
    Integer(u64, u64),
    /// One of a few whole numbers.
    OneOf(&'static [u64]),
    /// `true` or `false`.
    Bool,
    /// One of a few words.
    Word(&'static [Word]),
    /// `"auto"` (also `null`), stored as absent, or a value of the inner domain.
    Auto(&'static Domain),
    /// One of several records told apart by a tag: `{"rule": "settled", "e_drift": 1e-3}`. The bare word `"settled"`
    /// stands for the record with every default.
    Tagged {
        /// Name of the tag.
        tag: &'static str,
        /// The records.
        variants: &'static [Variant],
    },
    /// A record with keys of its own.
    Record(&'static [Key]),
    /// A list of values of the inner domain.
    List {
        /// Domain of each element.
        of: &'static Domain,
        /// Fewest elements.
        min: usize,
        /// Most elements.
        max: usize,
    },
}

/// End of an interval of real numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The end belongs to the interval.
    Including(f64),
    /// The end does not belong to the interval.
    Excluding(f64),
    /// No end.
    Open,
}

/// A word a key admits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// What it stands for.
    pub meaning: &'static str,
}

/// One record of a [`Domain::Tagged`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// Value of the tag.
    pub name: &'static str,
    /// What it stands for.
    pub meaning: &'static str,
    /// The keys beside the tag.
    pub keys: &'static [Key],
}

/// 2⁵³ − 1: larger whole numbers do not survive JSON (RFC 8785 writes them as doubles).
pub const LARGEST_INTEGER: u64 = (1 << 53) - 1;

impl Domain {
    /// A number above zero.
    pub const POSITIVE: Self = Self::Real(Bound::Excluding(0.0), Bound::Open);
    /// Zero or a number above it.
    pub const NOT_NEGATIVE: Self = Self::Real(Bound::Including(0.0), Bound::Open);
    /// A seed of random numbers.
    pub const SEED: Self = Self::Integer(0, LARGEST_INTEGER);

    /// Whether values are numbers (so that ranges and `where` apply).
    #[must_use]
    pub fn is_numeric(&self) -> bool {
        match self {
            Self::Real(..) | Self::Integer(..) | Self::OneOf(_) => true,
            Self::Auto(inner) => inner.is_numeric(),
            _ => false,
        }
    }

    /// Whether values are whole numbers.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        match self {
            Self::Integer(..) | Self::OneOf(_) => true,
            Self::Auto(inner) => inner.is_whole(),
            _ => false,
        }
    }

    /// The domain in words, for remedies and documentation.
    #[must_use]
    pub fn describe(&self) -> String {
        match self {
            Self::Real(low, high) => describe_interval(*low, *high),
            Self::Integer(low, high) if *high >= LARGEST_INTEGER => format!("a whole number ≥ {low}"),
            Self::Integer(low, high) => format!("a whole number from {low} to {high}"),
            Self::OneOf(numbers) => one_of(numbers.iter().map(u64::to_string)),
            Self::Bool => "true or false".to_owned(),
            Self::Word(words) => one_of(words.iter().map(|word| format!("\"{}\"", word.name))),
            Self::Auto(inner) => format!("\"auto\" or {}", inner.describe()),
            Self::Tagged { tag, variants } => {
                let names = one_of(variants.iter().map(|variant| format!("\"{}\"", variant.name)));
                format!("an object with \"{tag}\" {names}, or that word alone")
            }
            Self::Record(keys) => {
                let names: Vec<&str> = keys.iter().map(|key| key.name).collect();
                format!("an object with the keys {}", names.join(", "))
            }
            Self::List { of, min, max } => format!("a list of {min} to {max} values, each {}", of.describe()),
        }
    }
}

fn describe_interval(low: Bound, high: Bound) -> String {
    match (low, high) {
        (Bound::Open, Bound::Open) => "a number".to_owned(),
        (Bound::Including(low), Bound::Open) => format!("a number ≥ {low}"),
        (Bound::Excluding(low), Bound::Open) => format!("a number > {low}"),
        (Bound::Open, Bound::Including(high)) => format!("a number ≤ {high}"),
        (Bound::Open, Bound::Excluding(high)) => format!("a number < {high}"),
        (low, high) => {
            let left = if matches!(low, Bound::Excluding(_)) { "(" } else { "[" };
            let right = if matches!(high, Bound::Excluding(_)) { ")" } else { "]" };
            format!("a number in {left}{}, {}{right}", low.number(), high.number())
        }
    }
}

fn one_of(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        Some((only, _)) => only.clone(),
        None => "nothing".to_owned(),
    }
}

impl Bound {
    fn number(self) -> f64 {
        match self {
            Self::Including(end) | Self::Excluding(end) => end,
            Self::Open => f64::INFINITY,
        }
    }

    fn admits_from_below(self, value: f64) -> bool {
        match self {
            Self::Including(end) => value >= end,
            Self::Excluding(end) => value > end,
            Self::Open => true,
        }
    }

    fn admits_from_above(self, value: f64) -> bool {
        match self {
            Self::Including(end) => value <= end,
            Self::Excluding(end) => value < end,
            Self::Open => true,
        }
    }
}
