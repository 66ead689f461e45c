//! Which format an answer has: `?format=` before `Accept`.

use axum::http::HeaderMap;
use axum::http::header::ACCEPT;

use crate::error::{AppError, AppResult};

/// A format on offer: its name for `?format=` and its media types.
pub(super) struct Offer<T> {
    pub name: &'static str,
    pub media: &'static [&'static str],
    pub format: T,
}

/// Chooses among offers; the first is the default.
pub(super) fn choose<T: Copy>(
    asked: Option<&str>,
    headers: &HeaderMap,
    offers: &[Offer<T>],
    offered: &'static str,
) -> AppResult<T> {
    if let Some(asked) = asked {
        return offers
            .iter()
            .find(|offer| offer.name == asked)
            .map(|offer| offer.format)
            .ok_or_else(|| AppError::NotAcceptable { asked: format!("format={asked:.40}"), offered });
    }
    let accept: Vec<&str> = headers.get_all(ACCEPT).iter().filter_map(|value| value.to_str().ok()).collect();
    if accept.is_empty() {
        return Ok(offers[0].format);
    }
    let mut wanted: Vec<(f32, String)> = accept
        .iter()
        .flat_map(|line| line.split(','))
        .map(|range| {
            let mut parts = range.split(';').map(str::trim);
            let media = parts.next().unwrap_or_default().to_ascii_lowercase();
            let weight = parts.find_map(|part| part.strip_prefix("q=")).and_then(|text| text.parse().ok());
            (weight.unwrap_or(1.0), media)
        })
        .filter(|(weight, _)| *weight > 0.0)
        .collect();
    wanted.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, media) in &wanted {
        let found = offers.iter().find(|offer| {
            media == "*/*"
                || offer.media.iter().any(|one| {
                    one == media
                        || media.strip_suffix("/*").is_some_and(|kind| one.split('/').next() == Some(kind))
                })
        });
        if let Some(offer) = found {
            return Ok(offer.format);
        }
    }
    Err(AppError::NotAcceptable { asked: format!("{:.100}", accept.join(", ")), offered })
}

#[cfg(test)]
mod tests {
    use axum::http::HeaderValue;

    use super::*;

    const OFFERS: &[Offer<char>] = &[
        Offer { name: "json", media: &["application/json"], format: 'j' },
        Offer { name: "csv", media: &["text/csv"], format: 'c' },
    ];

    fn chosen(asked: Option<&str>, accept: Option<&'static str>) -> Option<char> {
        let mut headers = HeaderMap::new();
        if let Some(accept) = accept {
            headers.insert(ACCEPT, HeaderValue::from_static(accept));
        }
        choose(asked, &headers, OFFERS, "json, csv").ok()
    }

    #[test]
    fn the_query_goes_over_the_header_and_weights_count() {
        assert_eq!(chosen(None, None), Some('j'));
        assert_eq!(chosen(None, Some("*/*")), Some('j'));
        assert_eq!(chosen(None, Some("text/csv")), Some('c'));
        assert_eq!(chosen(None, Some("text/*;q=0.5, application/json;q=0.1")), Some('c'));
        assert_eq!(chosen(Some("json"), Some("text/csv")), Some('j'));
        assert_eq!(chosen(Some("xls"), None), None);
        assert_eq!(chosen(None, Some("image/png")), None);
    }
}
