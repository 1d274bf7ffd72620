//! Colours of a surface: bands between round values.
//!
//! Light and shade darken a colour. On a continuous scale a darker colour would be read as another value; with bands it is not, as their
//! borders stay where they are.

use crate::axis::ticks;
use crate::colour;

/// Number of shades of a colour.
const SHADES: usize = 16;

/// Brightness of a surface seen edge on.
const DARKEST: f64 = 0.62;

/// Largest number of bands; with their shades, and the shades of unclaimed values and of insides, they fit into a palette.
const MOST_BANDS: usize = 12;

/// Number of bands aimed at.
const BANDS: f64 = 10.0;

/// Colours of surfaces of which nothing is claimed: stripes, as where a map has no result.
const UNCLAIMED: [[u8; 3]; 2] = [[0xe9, 0xe9, 0xe9], [0xb5, 0xb5, 0xb5]];

/// Period of the stripes along a line, pixels: it holds both colours.
const STRIPES: usize = 14;

/// Colour of insides.
pub(super) const INSIDE: [u8; 3] = [0xec, 0xe4, 0xd6];

/// Colour of edges.
const INK: [u8; 3] = [0x22, 0x22, 0x22];

/// Colour of the outline at rest.
pub(super) const AT_REST: [u8; 3] = [0x9a, 0x8f, 0x86];

/// Bands of values.
#[derive(Debug)]
pub(super) struct Levels {
    /// Range of values from the lowest to the highest, both round.
    pub(super) values: (f64, f64),
    /// Borders of the bands, with their labels.
    pub(super) borders: Vec<(f64, String)>,
    count: usize,
}

impl Levels {
    /// Chooses bands for the finite values; none if there are none. Values that are never negative begin at 0.
    pub(super) fn of(values: &[Option<f64>]) -> Option<Self> {
        let found = values.iter().flatten().filter(|value| value.is_finite());
        let (low, high) = found.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        if low > high {
            return None;
        }
        let low = if low >= 0.0 { 0.0 } else { low };
        // A value that is the same everywhere needs a colour, too.
        let high =
            if high - low > 1e-9 * high.abs().max(low.abs()) { high } else { low + low.abs().max(1.0) };
        let inner = ticks((low, high), BANDS);
        let step = match inner[..] {
            [(a, _), (b, _), ..] => b - a,
            _ => high - low,
        };
        let values = (step * (low / step + 1e-9).floor(), step * (high / step - 1e-9).ceil());
        let count = (((values.1 - values.0) / step).round() as usize).clamp(1, MOST_BANDS);
        Some(Self { values, borders: ticks(values, count as f64), count })
    }

    /// Index of the band of a value.
    fn band(&self, value: f64) -> usize {
        let share = (value - self.values.0) / (self.values.1 - self.values.0);
        ((share * self.count as f64) as usize).min(self.count - 1)
    }

    fn colour(&self, band: usize) -> [u8; 3] {
        colour::level((band as f64 + 0.5) / self.count as f64)
    }

    /// Colours at the two ends of every band, at their shares of the scale.
    pub(super) fn stops(&self) -> impl Iterator<Item = (f64, [u8; 3])> + '_ {
        let share = |border: usize| border as f64 / self.count as f64;
        (0..self.count)
            .flat_map(move |band| [(share(band), self.colour(band)), (share(band + 1), self.colour(band))])
    }
}

/// Index of a shade in the palette of [`palette`].
pub(super) fn shade(colour: usize, light: f64) -> u8 {
    let shade = (light.clamp(0.0, 1.0) * (SHADES - 1) as f64).round() as usize;
    (colour * SHADES + shade) as u8
}

/// Index of the colour of a value in a pixel.
pub(super) fn of_value(levels: Option<&Levels>, value: f64, (column, line): (usize, usize)) -> usize {
    match levels {
        Some(levels) if !value.is_nan() => 3 + levels.band(value),
        _ => usize::from((column + line) % STRIPES < STRIPES / 2),
    }
}

/// Index of the colour of insides.
pub(super) const OF_INSIDE: usize = 2;

/// Index of the colour of edges in the palette.
pub(super) const OF_EDGE: u8 = 253;

/// Index of the colour of the outline at rest in the palette.
pub(super) const OF_REST: u8 = 254;

/// Palette of all colours in all shades: red, green and blue of 256 entries.
pub(super) fn palette(levels: Option<&Levels>) -> Vec<u8> {
    let bands = levels.map_or(0, |levels| levels.count);
    let bands = (0..bands).filter_map(|band| levels.map(|levels| levels.colour(band)));
    let colours = UNCLAIMED.into_iter().chain([INSIDE]).chain(bands);
    let shaded = |colour: [u8; 3], shade: usize| {
        let brightness = DARKEST + (1.0 - DARKEST) * shade as f64 / (SHADES - 1) as f64;
        colour.map(|channel| (f64::from(channel) * brightness).round() as u8)
    };
    let shades = colours.flat_map(|colour| (0..SHADES).flat_map(move |shade| shaded(colour, shade)));
    let mut palette: Vec<u8> = shades.collect();
    palette.resize(3 * usize::from(OF_EDGE), 0);
    palette.extend(INK.into_iter().chain(AT_REST).chain([0; 3]));
    palette
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_lie_between_round_values() {
        let of = |values: &[f64]| {
            Levels::of(&values.iter().map(|value| Some(*value)).collect::<Vec<_>>()).unwrap()
        };
        let levels = of(&[3.0, 247.0]);
        assert_eq!((levels.values, levels.count), ((0.0, 250.0), 5));
        assert_eq!([0.0, 49.9, 50.1, 250.0].map(|value| levels.band(value)), [0, 0, 1, 4]);
        assert_eq!(levels.borders.len(), 6);
        let (low, high) = of(&[-1.0, 1.0]).values;
        assert!((low + 1.0).abs() < 1e-12 && (high - 1.0).abs() < 1e-12);
        for values in
            [&[0.0][..], &[5.0, 5.0], &[-2.0], &[1e-300, 2e-300], &[-1e300, 1e300], &[1.0, 1.0 + 1e-15]]
        {
            let levels = of(values);
            assert!(levels.count <= MOST_BANDS && levels.values.0 < levels.values.1, "{values:?} {levels:?}");
            assert_eq!(palette(Some(&levels)).len(), 3 * 256);
        }
        assert!(Levels::of(&[None, Some(f64::NAN)]).is_none());
    }

    /// Shades of a band stay darker than the next higher band in the same light, and have the hue of their band.
    #[test]
    fn shades_do_not_leave_the_order_of_the_scale() {
        let levels = Levels::of(&[Some(0.0), Some(10.0)]).unwrap();
        let palette = palette(Some(&levels));
        let grey = |value: f64, light: f64| {
            let at = 3 * usize::from(shade(of_value(Some(&levels), value, (0, 0)), light));
            0.2126 * f64::from(palette[at])
                + 0.7152 * f64::from(palette[at + 1])
                + 0.0722 * f64::from(palette[at + 2])
        };
        for light in [0.0, 0.5, 1.0] {
            let greys: Vec<f64> = (0..10).map(|i| grey(f64::from(i) + 0.5, light)).collect();
            assert!(greys.windows(2).all(|pair| pair[1] > pair[0]), "{greys:?}");
        }
    }
}
