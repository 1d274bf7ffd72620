//! Trajectories of blade tips before the lobes of their casing, seen from beside the wheel.

use super::document::{Figure, axis};
use super::marks::{line, template};
use super::palette::{NEUTRAL, colour, dash};
use super::text::escaped;
use super::thinned;
use crate::cells::rpm;
use crate::trajectories::{self as drawing, ANGLE, NO_TIPS, View};
use rubmap_analysis::result::SpeedHistories;

/// Outward motion of every tip that a radial or normal sensor records over its angle in the fixed frame, and the casing that it meets there
/// with its shape at full height.
pub fn trajectories(histories: &SpeedHistories) -> Figure {
    let view = View::new(histories, ((0.0, 0.0), (1.0, 1.0)));
    let length = &histories.units.length;
    let told = |words: &str| {
        template(&format!("{}<br>%{{x:.1f}}°: %{{y:.4~g}} {}", escaped(words), escaped(length)))
    };
    let casings = view.walls.iter().enumerate().map(|(index, place)| {
        let wall = line(view.casing_words(), drawing::wall(place).map(Some), (NEUTRAL, "solid", 2.0));
        wall.hovertemplate(told(&drawing::wall_words(place))).legendgroup("casing").showlegend(index == 0)
    });
    let mut together = 1;
    let mut paths = Vec::new();
    for (index, tip) in view.tips.iter().enumerate() {
        let mut places = Vec::new();
        let motion = view.motion(tip);
        let revolutions: Vec<_> = motion.split(Option::is_none).collect();
        for revolution in &revolutions {
            let revolution = revolution.iter().flatten().copied().collect();
            let (here, one) = thinned::thinned(revolution, view.tips.len() * revolutions.len());
            together = together.max(one);
            places.extend(here.into_iter().map(Some).chain([None]));
        }
        let colour = colour(index, view.tips.len().max(2));
        let words = tip.words();
        paths.push(line(&words, places, (&colour, dash(index), 1.3)).hovertemplate(told(&words)));
    }
    let mut paragraphs = drawing::words(histories);
    paragraphs.extend(thinned::words(together));
    let figure = Figure::new("trajectories", &drawing::title(histories), &paragraphs)
        .meta("speed_index", histories.index)
        .meta("speed_rpm", rpm(histories.speed_rad_s));
    if view.tips.is_empty() {
        return figure.empty(NO_TIPS);
    }
    figure
        .high(540)
        .with_all(casings.collect::<Vec<_>>())
        .with_all(paths)
        .axis("xaxis", axis(ANGLE).range([0.0, 360.0]).dtick(45.0).ticksuffix("°"))
        .axis("yaxis", axis(&drawing::outward(length)).range(<[f64; 2]>::from(view.diagram.y.values)))
}
