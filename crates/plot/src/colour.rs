//! Colours.

/// Degree-6 fit, in ascending powers, of matplotlib's `inferno` (public domain): dark where it is quiet, bright where
/// it is loud, perceptually uniform and monotone in grey.
const INFERNO: [[f64; 3]; 7] = [
    [0.000_218_940_4, 0.001_651_004_6, -0.019_480_898_4],
    [0.106_513_419_5, 0.563_956_436_8, 3.932_712_388_9],
    [11.602_493_082_5, -3.972_853_965_7, -15.942_394_106_3],
    [-41.703_996_131_4, 17.436_398_882_1, 44.354_145_198_7],
    [77.162_935_699_4, -33.402_358_942_1, -81.807_309_257_4],
    [-71.319_428_245_0, 32.626_064_264_0, 73.209_519_858_0],
    [25.131_126_224_8, -12.242_668_952_4, -23.070_325_002_9],
];

/// Degree-6 fit of matplotlib's `viridis` (public domain).
const VIRIDIS: [[f64; 3]; 7] = [
    [0.277_727_327_2, 0.005_407_344_5, 0.334_099_805_3],
    [0.105_093_043_1, 1.404_613_529_9, 1.384_590_162_6],
    [-0.330_861_828_7, 0.214_847_559_5, 0.095_095_163_0],
    [-4.634_230_499_0, -5.799_100_973_4, -19.332_440_956_3],
    [6.228_269_936_3, 14.179_933_366_8, 56.690_552_600_7],
    [4.776_384_997_7, -13.745_145_377_7, -65.353_032_633_4],
    [-5.435_455_855_9, 4.645_852_612_2, 26.312_435_249_6],
];

/// Amplitude colour of a share of the scale.
pub(super) fn amplitude(share: f64) -> [u8; 3] {
    polynomial(&INFERNO, share)
}

/// Colour of a share of a scale on surfaces, lighter than black at 0 so that light and shade show.
pub(super) fn level(share: f64) -> [u8; 3] {
    polynomial(&VIRIDIS, share)
}

/// Colour of one of `count` things in a natural order, all dark enough for lines on white.
pub(super) fn ordinal(index: usize, count: usize) -> String {
    /// Tol's bright scheme, in the order of the spectrum.
    const FEW: [&str; 7] = ["#aa3377", "#4477aa", "#1fa7c9", "#228833", "#b8a000", "#ee7733", "#cc3311"];
    if count <= FEW.len() {
        return FEW[index.min(FEW.len() - 1)].to_owned();
    }
    hex(polynomial(&VIRIDIS, 0.88 * index as f64 / (count - 1) as f64))
}

/// Colour of one of `count` things in a natural order, all light enough for lines on the colours of [`amplitude`].
pub(super) fn on_dark(index: usize, count: usize) -> String {
    const FEW: [&str; 7] = ["#ffffff", "#7fd6ff", "#9df59d", "#ffb3de", "#b9a8ff", "#4df0d0", "#ffe08a"];
    if count <= FEW.len() {
        return FEW[index.min(FEW.len() - 1)].to_owned();
    }
    let [r, g, b] = polynomial(&VIRIDIS, index as f64 / (count - 1) as f64);
    hex([r, g, b].map(|channel| 120 + (u16::from(channel) * 135 / 255) as u8))
}

/// Colours of Okabe and Ito's palette that the colour-blind tell apart as well, those that show as lines on white.
pub(super) const DISTINCT: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

pub(super) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn polynomial(coefficients: &[[f64; 3]; 7], share: f64) -> [u8; 3] {
    let t = share.clamp(0.0, 1.0);
    [0, 1, 2].map(|channel| {
        let value = coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c[channel]);
        (255.0 * value.clamp(0.0, 1.0)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn louder_is_brighter() {
        let grey = |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let greys: Vec<_> = (0..=50).map(|i| grey(amplitude(f64::from(i) / 50.0))).collect();
        assert!(greys.windows(2).all(|pair| pair[1] > pair[0] - 0.5), "{greys:?}");
        assert!(greys[0] < 5.0 && greys[50] > 220.0);
        assert_eq!(amplitude(f64::NAN.max(0.0)), amplitude(0.0));
    }
}
