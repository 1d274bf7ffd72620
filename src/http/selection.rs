//! Selections of parts of results: `speeds`, `orders` and `sensors` of a query.

use super::problem::{Problem, excerpt};
use crate::analysis::request::SpeedUnit;

/// Largest difference between a number and the engine order that it names: engine orders are quotients.
const SAME_ORDER: f64 = 1e-9;

/// Indices of the speeds that `text` names: indices and ranges of them, or ranges in a unit; in ascending order.
///
/// # Errors
/// If `text` is not a selection, or selects what the job does not have; also for the functions below.
pub(super) fn speeds(text: &str, speeds_rad_s: &[f64]) -> Result<Vec<u32>, Problem> {
    let wrong = |detail| Problem::parameter("speeds", detail);
    let mut chosen = vec![false; speeds_rad_s.len()];
    for item in text.split(',').map(str::trim) {
        match unit(item) {
            None => choose_indices(&mut chosen, item, "speed").map_err(wrong)?,
            Some((range, unit)) => {
                let (from, to) = reals(range).map_err(wrong)?;
                let range = from * unit.rad_s()..=to * unit.rad_s();
                let mut found = false;
                for (chosen, _) in
                    chosen.iter_mut().zip(speeds_rad_s).filter(|(_, speed)| range.contains(speed))
                {
                    (*chosen, found) = (true, true);
                }
                if !found {
                    return Err(wrong(format!("no speed of the job is in {:?}", excerpt(item))));
                }
            }
        }
    }
    Ok(indices(&chosen))
}

/// Indices of the sensors that `text` names: indices and ranges of them.
pub(super) fn sensors(text: &str, sensors: usize) -> Result<Vec<u32>, Problem> {
    list("sensors", text, sensors, "sensor")
}

/// Indices, from 0 to `total` − 1, that `text` names.
pub(super) fn list(parameter: &str, text: &str, total: usize, thing: &str) -> Result<Vec<u32>, Problem> {
    let mut chosen = vec![false; total];
    for item in text.split(',').map(str::trim) {
        choose_indices(&mut chosen, item, thing).map_err(|detail| Problem::parameter(parameter, detail))?;
    }
    Ok(indices(&chosen))
}

/// Columns of the engine orders that `text` names: numbers and ranges.
pub(super) fn orders(text: &str, engine_orders: &[f64]) -> Result<Vec<usize>, Problem> {
    let wrong = |detail| Problem::parameter("orders", detail);
    let mut chosen = vec![false; engine_orders.len()];
    for item in text.split(',').map(str::trim) {
        let (from, to) = reals(item).map_err(wrong)?;
        let range = from - SAME_ORDER..=to + SAME_ORDER;
        let mut found = false;
        for (chosen, _) in chosen.iter_mut().zip(engine_orders).filter(|(_, order)| range.contains(order)) {
            (*chosen, found) = (true, true);
        }
        if !found {
            let (first, last) = (engine_orders.first().unwrap_or(&0.0), engine_orders.last().unwrap_or(&0.0));
            let step = engine_orders.get(1).unwrap_or(&0.0);
            return Err(wrong(format!(
                "no engine order of the job is in {:?}: they go from {first} to {last} in steps of {step}",
                excerpt(item)
            )));
        }
    }
    Ok(indices(&chosen).into_iter().map(|column| column as usize).collect())
}

fn indices(chosen: &[bool]) -> Vec<u32> {
    (0..).zip(chosen).filter(|(_, chosen)| **chosen).map(|(index, _)| index).collect()
}

fn choose_indices(chosen: &mut [bool], item: &str, thing: &str) -> Result<(), String> {
    let total = chosen.len();
    let number = |text: &str| text.trim().parse::<usize>().ok();
    let (from, to) = match item.split_once('-') {
        Some((from, to)) => (number(from), number(to)),
        None => (number(item), number(item)),
    };
    let (Some(from), Some(to)) = (from, to) else {
        return Err(format!("expected indices and ranges of them such as 0-9,15, not {:?}", excerpt(item)));
    };
    if from > to {
        return Err(format!("the range {:?} ends before it begins", excerpt(item)));
    }
    match chosen.get_mut(from..=to) {
        Some(range) => range.fill(true),
        None => return Err(format!("there is no {thing} {to}: the job has {total}, counted from 0")),
    }
    Ok(())
}

/// Reads a number, or a range of numbers.
fn reals(item: &str) -> Result<(f64, f64), String> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    let (from, to) = match item.split_once('-') {
        Some((from, to)) => (number(from), number(to)),
        None => (number(item), number(item)),
    };
    match (from, to) {
        (Some(from), Some(to)) if from > to => {
            Err(format!("the range {:?} ends before it begins", excerpt(item)))
        }
        (Some(from), Some(to)) => Ok((from, to)),
        _ => Err(format!("expected numbers and ranges of them such as 0-8,12, not {:?}", excerpt(item))),
    }
}

/// Splits a range in a unit into the range and its unit.
fn unit(item: &str) -> Option<(&str, SpeedUnit)> {
    let units = [("rpm", SpeedUnit::Rpm), ("rad_s", SpeedUnit::RadS), ("hz", SpeedUnit::Hz)];
    units.into_iter().find_map(|(word, unit)| Some((item.strip_suffix(word)?, unit)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges_are_read() {
        let rpm = |rpm: f64| rpm * SpeedUnit::Rpm.rad_s();
        let grid = [rpm(100.0), rpm(200.0), rpm(300.0), rpm(400.0)];
        assert_eq!(speeds("0-1,3", &grid).unwrap(), [0, 1, 3]);
        assert_eq!(speeds("3, 0-1,1", &grid).unwrap(), [0, 1, 3]);
        assert_eq!(speeds("150-350rpm,0", &grid).unwrap(), [0, 1, 2]);
        assert_eq!(speeds("2-6hz", &grid).unwrap(), [1, 2], "120 to 360 rpm");
        assert_eq!(sensors("1", 2).unwrap(), [1]);
        let halves = [0.0, 0.5, 1.0, 1.5];
        assert_eq!(orders("0-1", &halves).unwrap(), [0, 1, 2]);
        assert_eq!(orders("1.5,0.5", &halves).unwrap(), [1, 3]);
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        let grid = [1.0, 2.0];
        for (text, words) in [
            ("1-0", "ends before it begins"),
            ("99999999", "there is no speed 99999999"),
            ("0-99999999999999999999", "expected indices"),
            ("", "expected indices"),
            ("0,,1", "expected indices"),
            ("-1", "expected indices"),
            ("5-9rad_s", "no speed of the job is in"),
            ("nan-infrpm", "expected numbers"),
        ] {
            let problem = speeds(text, &grid).unwrap_err();
            assert!(problem.status == 400 && problem.detail.contains(words), "{text}: {}", problem.detail);
        }
        for (text, words) in [("nan", "expected numbers"), ("2-1", "ends before"), ("0.3", "in steps of 1")] {
            let problem = orders(text, &[0.0, 1.0, 2.0]).unwrap_err();
            assert!(problem.status == 400 && problem.detail.contains(words), "{text}: {}", problem.detail);
        }
    }
}
