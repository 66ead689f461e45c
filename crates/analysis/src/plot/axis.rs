//! Linear and logarithmic axes: mapping to the unit interval, ticks, tick labels.

/// Scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scale {
    Linear,
    Log,
}

/// An axis with its range in data units.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub label: String,
    pub scale: Scale,
    pub low: f64,
    pub high: f64,
}

/// A tick; minor ticks have no label.
pub(super) struct Tick {
    pub at: f64,
    pub label: Option<String>,
}

impl Axis {
    /// An axis that holds all finite values (on a logarithmic axis: positive ones) with a margin.
    pub fn around(label: &str, scale: Scale, values: impl Iterator<Item = f64>) -> Self {
        let usable = values.filter(|v| v.is_finite() && (scale == Scale::Linear || *v > 0.0));
        let (mut low, mut high) =
            usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if !low.is_finite() {
            (low, high) = if scale == Scale::Log { (0.1, 10.0) } else { (0.0, 1.0) };
        }
        match scale {
            Scale::Linear => {
                let margin = if high > low { 0.06 * (high - low) } else { 0.5 * high.abs().max(1.0) };
                Self { label: label.to_owned(), scale, low: low - margin, high: high + margin }
            }
            Scale::Log => {
                let factor = if high > low { (high / low).powf(0.05).max(1.15) } else { 3.0 };
                Self { label: label.to_owned(), scale, low: low / factor, high: high * factor }
            }
        }
    }

    /// Position in [0, 1] along the axis; nothing outside it.
    pub fn place(&self, value: f64) -> Option<f64> {
        let at = match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log => (value / self.low).ln() / (self.high / self.low).ln(),
        };
        (at.is_finite() && (-1e-9..=1.0 + 1e-9).contains(&at)).then_some(at)
    }

    pub fn ticks(&self) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => linear_ticks(self.low, self.high),
            Scale::Log => log_ticks(self.low, self.high),
        }
    }
}

fn linear_ticks(low: f64, high: f64) -> Vec<Tick> {
    let raw = (high - low) / 8.0;
    let power = 10.0_f64.powf(raw.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= raw).unwrap_or(10.0 * power);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small positive number of digits"
    )]
    let digits = (-step.log10().floor()).max(0.0) as usize;
    let mut ticks = Vec::new();
    let mut index = (low / step).ceil();
    while index * step <= high * (1.0 + 1e-12) {
        let value = index * step;
        let value = if value.abs() < 1e-9 * step { 0.0 } else { value };
        ticks.push(Tick { at: value, label: Some(minus(&format!("{value:.digits$}"))) });
        index += 1.0;
    }
    ticks
}

fn log_ticks(low: f64, high: f64) -> Vec<Tick> {
    let decades = (high / low).log10();
    let every = if decades > 9.0 { 2 } else { 1 };
    let fine = decades < 1.6;
    #[expect(clippy::cast_possible_truncation, reason = "exponents of doubles are small")]
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let mut ticks = Vec::new();
    for exponent in first..=last {
        for digit in 1..10 {
            let at = f64::from(digit) * 10.0_f64.powi(exponent);
            if at < low * (1.0 - 1e-12) || at > high * (1.0 + 1e-12) {
                continue;
            }
            let labelled = (digit == 1 && exponent % every == 0) || (fine && [2, 5].contains(&digit));
            let label = labelled.then(|| if fine { plain(at) } else { power_of_ten(exponent) });
            ticks.push(Tick { at, label });
        }
    }
    ticks
}

/// A number without needless digits.
pub(crate) fn plain(value: f64) -> String {
    if value != 0.0 && !(1e-3..2e4).contains(&value.abs()) {
        let text = format!("{value:.1e}");
        let (mantissa, exponent) = text.split_once('e').expect("scientific notation has an exponent");
        let power = power_of_ten(exponent.parse().expect("an exponent is a whole number"));
        let mantissa = mantissa.strip_suffix(".0").unwrap_or(mantissa);
        return if mantissa == "1" { power } else { minus(&format!("{mantissa}·{power}")) };
    }
    // four significant digits
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 6")]
    let digits = if value == 0.0 { 0 } else { (3.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') { minus(text.trim_end_matches('0').trim_end_matches('.')) } else { minus(&text) }
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// 10 with the exponent in superscript digits.
pub(super) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits =
        exponent.abs().to_string().chars().map(|c| DIGITS[c as usize - '0' as usize]).collect::<String>();
    format!("10{}{digits}", if exponent < 0 { "⁻" } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis { label: "x".to_owned(), scale: Scale::Linear, low: 0.13, high: 1.84 };
        let ticks = axis.ticks();
        assert_eq!(ticks[0].label.as_deref(), Some("0.5"));
        assert!(ticks.iter().all(|tick| axis.place(tick.at).is_some()));
        let log = Axis::around("x", Scale::Log, [3e-4, 20.0, -1.0, f64::NAN].into_iter());
        let labels: Vec<String> = log.ticks().into_iter().filter_map(|tick| tick.label).collect();
        assert_eq!(labels, ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
        assert!(log.place(-1.0).is_none() && log.place(1e9).is_none());
    }

    #[test]
    fn numbers_read_well() {
        let cases = [
            (0.05, "0.05"),
            (1.0, "1"),
            (-2.5, "−2.5"),
            (1e4, "10000"),
            (2236.067977, "2236"),
            (2e5, "2·10⁵"),
            (1e-4, "10⁻⁴"),
        ];
        for (value, text) in cases {
            assert_eq!(plain(value), text);
        }
        assert_eq!(power_of_ten(-12), "10⁻¹²");
    }

    #[test]
    fn degenerate_data_still_have_an_axis() {
        for scale in [Scale::Linear, Scale::Log] {
            assert!(Axis::around("x", scale, std::iter::empty()).ticks().len() > 1);
            assert!(Axis::around("x", scale, std::iter::once(2.0)).place(2.0).is_some());
        }
    }
}
