//! Drawings by each of the pens, for tests that read them back.

use crate::{
    ForceQuantity, Frame, HaighColour, HistoryQuantity, LevelColour, SectionView, SpectrogramUnit,
    VerticalAxis, Window,
};
use rubmap_analysis::result::{
    Branches, Campaign, Campbell, CriticalSpeeds, ForceMap, InteractionMap, Point, Quantity, RunUps,
    SectorGeometry, SpeedHistories, SpeedSpectra, SweepStress, WearMap,
};
use rubmap_analysis::run::{Histories, WorkPrecision};
use rubmap_wheel::dynamics::sector::Units;

/// Defines for every drawing a function that draws it as SVG, and one that makes the figure.
macro_rules! pens {
    ($($name:ident($($of:ident: $type:ty),*);)*) => {
        pub(crate) mod svg {
            use super::*;
            maps!(String, svg);
            $(pub(crate) fn $name($($of: $type),*) -> String { crate::$name($($of),*).svg() })*
        }
        pub(crate) mod figure {
            use super::*;
            maps!(crate::Figure, figure);
            $(pub(crate) fn $name($($of: $type),*) -> crate::Figure { crate::$name($($of),*).figure() })*
        }
    };
}

/// Defines the functions of interaction maps.
macro_rules! maps {
    ($form:ty, $pen:ident) => {
        pub(crate) fn interaction_map(
            of: &InteractionMap,
            critical: Option<&CriticalSpeeds>,
            campbell: Option<&Campbell>,
            axis: VerticalAxis,
            window: Window,
            colour: LevelColour,
        ) -> $form {
            crate::interaction_map(of, critical.cloned(), campbell, axis, window, colour).$pen()
        }

        pub(crate) fn fixed_frame_map(
            of: &InteractionMap,
            critical: Option<&CriticalSpeeds>,
            axis: VerticalAxis,
            window: Window,
            colour: LevelColour,
        ) -> $form {
            crate::fixed_frame_map(of, critical.cloned(), axis, window, colour).$pen()
        }
    };
}

pens! {
    branches(of: &Branches, sensor: usize, marched: &[Point]);
    campaign(of: &Campaign, parameter: usize);
    campbell(of: &Campbell);
    campbell_fixed_frame(of: &Campbell);
    critical_speeds(of: &CriticalSpeeds);
    error_over_step(of: &WorkPrecision, speed: usize, quantity: Quantity);
    force_map(of: &ForceMap, quantity: ForceQuantity);
    haigh(of: &SweepStress, by: HaighColour);
    histories(of: &Histories, sensor: usize);
    map_sheet(of: &[InteractionMap], window: Window, colour: LevelColour);
    run_ups(of: &RunUps, sensor: usize, swept: &[Point]);
    section(of: &SectorGeometry, view: SectionView);
    spectrogram(of: &RunUps, run: usize, sensor: usize, unit: SpectrogramUnit);
    spectrum(of: &SpeedSpectra, point: &Point, units: &Units, sensor: usize, frame: Frame);
    speed_histories(of: &SpeedHistories, what: HistoryQuantity, index: usize);
    trajectories(of: &SpeedHistories);
    wear_map(of: &WearMap, point: &Point, units: &Units);
    work_precision(of: &WorkPrecision, speed: usize, quantity: Quantity);
}
