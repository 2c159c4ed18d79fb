//! Numbers as people write them.

use crate::math::Portable;

/// A share in percent, to two or three digits.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", digits(100.0 * share))
}

/// A time, to two or three digits.
pub(super) fn time(seconds: f64) -> String {
    const UNITS: [(f64, &str); 5] =
        [(86_400.0 * 365.25, "years"), (86_400.0, "days"), (3600.0, "h"), (60.0, "min"), (1.0, "s")];
    let unit = UNITS.into_iter().find(|(unit, name)| seconds >= if *name == "s" { 0.0 } else { 2.0 * unit });
    let (unit, name) = unit.unwrap_or((1.0, "s"));
    format!("{} {name}", digits(seconds / unit))
}

/// The same text without zeros that say nothing, for numbers that are round.
pub(super) fn round(text: &str) -> String {
    match text.split_once(' ') {
        Some((number, unit)) if number.contains('.') => {
            format!("{} {unit}", number.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text.to_owned(),
    }
}

/// A number to two digits, or three from 100 up; grouped in thousands above.
pub(super) fn digits(number: f64) -> String {
    if !number.is_finite() {
        return "∞".into();
    }
    if number == 0.0 {
        return "0".into();
    }
    let decade = (Portable::ln(number.abs()) / std::f64::consts::LN_10 + 1e-9).floor() as i32;
    let places = (1 - decade).clamp(0, 9) as usize;
    let rounded = format!("{number:.places$}");
    // 9.96 rounds to 10.0, which is a digit too many.
    match rounded.split_once('.') {
        Some((whole, part)) if whole.trim_start_matches('-').len() > 1 && !part.is_empty() => grouped(number.round()),
        Some(_) => rounded,
        None => grouped(number.round()),
    }
}

/// A whole number with thin gaps between thousands.
pub(super) fn grouped(number: f64) -> String {
    let plain = format!("{:.0}", number.abs());
    let mut text = String::new();
    for (place, digit) in plain.chars().enumerate() {
        if place > 0 && plain.len() > 4 && (plain.len() - place) % 3 == 0 {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    if number < 0.0 { format!("−{text}") } else { text }
}

/// The first letter as at the beginning of a sentence.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_two_digits() {
        for (number, text) in [
            (0.004_56, "0.0046"),
            (0.5, "0.50"),
            (1.0, "1.0"),
            (9.96, "10"),
            (42.3, "42"),
            (123.4, "123"),
            (12_345.0, "12\u{2009}345"),
            (-3.21, "-3.2"),
            (0.0, "0"),
        ] {
            assert_eq!(digits(number), text);
        }
        assert_eq!((percent(0.0123).as_str(), percent(1.94).as_str()), ("1.2 %", "194 %"));
        let times = [0.034, 59.0, 119.0, 121.0, 7100.0, 7300.0, 200_000.0, 1e9].map(time);
        assert_eq!(times, ["0.034 s", "59 s", "119 s", "2.0 min", "118 min", "2.0 h", "2.3 days", "32 years"]);
        assert_eq!(["0.50 %", "1.0 s", "100 s", "0.001 s"].map(round), ["0.5 %", "1 s", "100 s", "0.001 s"]);
        assert_eq!(capital("naive"), "Naive");
    }
}
