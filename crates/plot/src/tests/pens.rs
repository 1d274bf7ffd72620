//! Drawings by each of the pens, for tests that read them back.

use crate::{
    ForceQuantity, Frame, HaighColour, HistoryQuantity, LevelColour, SectionView, SpectrogramUnit,
    VerticalAxis, Window,
};
use rubmap_analysis::result::{
    Backbones, Branches, Campaign, Campbell, CriticalSpeeds, ForceMap, InteractionMap, Interference,
    LimitKind, Point, Quantity, RunUps, SectorGeometry, SpeedHistories, SpeedSpectra, SweepLevel,
    SweepStress, WearMap,
};
use rubmap_analysis::run::{Histories, WorkPrecision};
use rubmap_wheel::dynamics::sector::Units;

/// Defines for every drawing a function that draws it as SVG, and one that makes the figure.
macro_rules! pens {
    ($($drawn:path => $name:ident($($of:ident: $type:ty),*);)*) => {
        pub(crate) mod svg {
            use crate::tests::pens::*;
            maps!(String, svg);
            $(pub(crate) fn $name($($of: $type),*) -> String { $drawn($($of),*).svg() })*
        }
        pub(crate) mod figure {
            use crate::tests::pens::*;
            maps!(crate::Figure, figure);
            $(pub(crate) fn $name($($of: $type),*) -> crate::Figure { $drawn($($of),*).figure() })*
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
            crate::interaction_map(of, critical, campbell, axis, window, colour).$pen()
        }

        pub(crate) fn fixed_frame_map(
            of: &InteractionMap,
            critical: Option<&CriticalSpeeds>,
            axis: VerticalAxis,
            window: Window,
            colour: LevelColour,
        ) -> $form {
            crate::fixed_frame_map(of, critical, axis, window, colour).$pen()
        }
    };
}

pens! {
    crate::around => around(of: &SectorGeometry);
    crate::backbones => backbones(of: &Backbones);
    crate::branches => branches(of: &Branches, sensor: usize, marched: &[Point]);
    crate::campaign => campaign(of: &Campaign, parameter: usize);
    crate::campbell => campbell(of: &Campbell);
    crate::campbell_fixed_frame => campbell_fixed_frame(of: &Campbell);
    crate::critical_speeds => critical_speeds(of: &CriticalSpeeds);
    crate::error_over_step => error_over_step(of: &WorkPrecision, speed: usize, quantity: Quantity);
    crate::force_map => force_map(of: &ForceMap, quantity: ForceQuantity);
    crate::haigh => haigh(of: &SweepStress, by: HaighColour);
    crate::histories => histories(of: &Histories, sensor: usize);
    crate::interference => interference(of: &Interference);
    crate::map_sheet => map_sheet(of: &[InteractionMap], window: Window, colour: LevelColour);
    crate::run_ups => run_ups(of: &RunUps, sensor: usize, swept: &[Point]);
    crate::section => section(of: &SectorGeometry, view: SectionView);
    crate::spectrogram => spectrogram(of: &RunUps, run: usize, sensor: usize, unit: SpectrogramUnit);
    crate::spectrum => spectrum(of: &SpeedSpectra, point: &Point, units: &Units, sensor: usize, frame: Frame);
    crate::speed_histories => speed_histories(of: &SpeedHistories, what: HistoryQuantity, index: usize);
    crate::trajectories => trajectories(of: &SpeedHistories);
    crate::wheel_level => wheel_level(of: &SweepLevel, quantity: Option<LimitKind>);
    crate::wear_map => wear_map(of: &WearMap, point: &Point, units: &Units);
    crate::work_precision => work_precision(of: &WorkPrecision, speed: usize, quantity: Quantity);
}
