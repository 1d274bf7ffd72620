//! The default impeller in front of a casing with two lobes, as the service would integrate it.

use rubmap::analysis::effects::casing::request::{
    Casing as CasingRequest, Clearance, ClearanceState, Lobes as LobesRequest,
};
use rubmap::analysis::effects::contact::request::Contact;
use rubmap::analysis::effects::damping::request::Damping;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::analysis::request::speeds::{SpeedSet, SpeedUnit, Speeds};
use rubmap::analysis::request::{
    self, Component, FamiliesBy, Integration, SchemeChoice, Sensor, SweepDirection, SweepRequest,
};
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::PointStatus;
use rubmap::analysis::run::{ReducedSector, prepare, run_speed};
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::SectorModel;
use rubmap::impeller::ImpellerParameters;

pub(crate) const SPEED: f64 = 2500.0;
pub(crate) const DAMPING: f64 = 0.005;
/// Clearance at which some blade touches in every step once the restriction has grown.
pub(crate) const TOUCHING: f64 = 0.30;
/// Clearance at which no blade ever touches.
pub(crate) const FREE: f64 = 2.0;

/// Lobes of the casing.
const LOBES: Lobes = Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.0 };

/// Wheel with its damping and its scene.
pub(crate) struct Scene {
    pub(crate) reduced: ReducedSector,
    pub(crate) modal: ModalWheel,
    pub(crate) damping: ModalDamping,
    pub(crate) stiffening: bool,
    modes: usize,
}

/// Scheme and its steps per revolution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stepping {
    pub(crate) scheme: Scheme,
    pub(crate) steps: usize,
}

impl Scene {
    /// Makes the scene with `modes` fixed-interface modes at each of the first `stiffnesses` speeds of the default impeller.
    pub(crate) fn new(modes: usize, stiffnesses: usize) -> Self {
        Self::of(&ImpellerParameters::default(), modes, stiffnesses)
    }

    /// Makes the scene of the default impeller with a gyroscopic matrix.
    pub(crate) fn gyroscopic(modes: usize, stiffnesses: usize) -> Self {
        let parameters = ImpellerParameters { gyroscopic: true, ..ImpellerParameters::default() };
        Self::of(&parameters, modes, stiffnesses)
    }

    /// Makes the scene of any impeller.
    pub(crate) fn of(parameters: &ImpellerParameters, modes: usize, stiffnesses: usize) -> Self {
        let package = rubmap::impeller::generate(parameters).expect("the defaults are valid");
        let mut sector =
            rubmap::package::to_sector(package).expect("the generator makes valid packages").into_parts();
        sector.stiffness.truncate(stiffnesses);
        sector.speeds_rad_s.truncate(stiffnesses);
        let sector = SectorModel::new(sector).expect("as before, or at rest alone");
        let reduced = prepare(&sector, modes as u32, None, &NoCheckpoints, &Unwatched)
            .expect("the default impeller is sound");
        let stiffening = stiffnesses == 3;
        let modal = ModalWheel::at(&reduced.wheel, SPEED, RotationEffects::stiffening(stiffening))
            .expect("the default impeller is sound");
        let damping = ModalDamping { modal_ratio: DAMPING, family_ratios: Vec::new(), ranks: Vec::new() };
        Self { reduced, modal, damping, stiffening, modes }
    }

    /// Casing with this clearance at every node.
    pub(crate) fn casing(&self, clearance: f64) -> Casing {
        Casing {
            clearance: vec![clearance; self.reduced.wheel.contact.len()],
            restriction: Some(LOBES.into()),
            ramp_revolutions: 1.0,
        }
    }

    /// Request for [`Self::casing`] with contact at every speed of `speeds_rad_s`.
    pub(crate) fn request(
        &self,
        scheme: SchemeChoice,
        kept_modes: AutoOr,
        revolutions: usize,
        speeds_rad_s: Vec<f64>,
    ) -> ResolvedSweep {
        let casing = self.casing(TOUCHING);
        let lobes = LobesRequest {
            count: LOBES.count,
            amplitude: LOBES.amplitude,
            width_rad: LOBES.width_rad,
            phase_rad: LOBES.phase_rad,
            along_chord: None,
        };
        let values = Some(casing.clearance);
        let given = ClearanceState::Running;
        let clearance = Clearance { leading: None, trailing: None, values, given };
        let last = self.reduced.wheel.contact.len() as u32 - 1;
        let sensor = |contact_node| Sensor::at_contact(contact_node, 0, Component::Radial);
        let settings = SweepRequest {
            model: String::new(),
            modes_per_speed: AutoOr::Fixed(self.modes as u32),
            speeds: Speeds::One(SpeedSet {
                from: None,
                to: None,
                count: None,
                values: Some(speeds_rad_s),
                unit: SpeedUnit::RadS,
            }),
            scene: request::Scene {
                centrifugal_stiffening: self.stiffening,
                damping: Some(Damping {
                    modal_ratio: DAMPING,
                    family_ratios: Vec::new(),
                    families_by: FamiliesBy::default(),
                }),
                casing: Some(CasingRequest {
                    clearance,
                    lobes: Some(lobes),
                    single_lobes: Vec::new(),
                    waves: Vec::new(),
                    measured: None,
                    tilt: None,
                }),
                contact: Some(Contact {}),
                ..request::Scene::default()
            },
            integration: Integration {
                scheme,
                kept_modes,
                steps_per_revolution: AutoOr::Auto,
                revolutions: AutoOr::Fixed(revolutions as u32),
                ramp_revolutions: casing.ramp_revolutions,
                window_revolutions: 1,
                ..Integration::default()
            },
            sensors: vec![sensor(0), sensor(last)],
            max_engine_order: 24,
            peak_prominence: 0.1,
            sweep: SweepDirection::Independent,
            accuracy: None,
            budget: None,
            control_speeds: None,
            refine: Some(false),
            reproducible: false,
            fields: None,
            operation: None,
            limits: None,
            blade_thickness: None,
            record: request::Record::default(),
        };
        ResolvedSweep::stored(settings, 0).expect("the settings are sound")
    }

    /// Step of `scheme` that `auto` gives it against the casing.
    pub(crate) fn automatic(&self, scheme: SchemeChoice, kept_modes: AutoOr) -> Stepping {
        let request = self.request(scheme, kept_modes, 1, vec![SPEED]);
        let point = run_speed(&self.reduced, &request, 0, None, &Unwatched).expect("nobody cancels").point;
        assert_eq!(point.status, PointStatus::Completed, "{:?}", point.message);
        let report = point.scheme.expect("a completed run has a scheme");
        let scheme = match (report.name, report.kept_modes) {
            (SchemeChoice::CentralDifferences, _) => Scheme::CentralDifferences,
            (SchemeChoice::ExactModal, _) => Scheme::ExactModal,
            (SchemeChoice::MasslessBoundary, Some(kept)) => {
                Scheme::MasslessBoundary { kept_modes: kept as usize }
            }
            other => panic!("{other:?} is no scheme"),
        };
        Stepping { scheme, steps: point.steps_per_revolution as usize }
    }

    /// Every scheme at its own automatic step.
    pub(crate) fn schemes(&self) -> [Stepping; 3] {
        [SchemeChoice::CentralDifferences, SchemeChoice::ExactModal, SchemeChoice::MasslessBoundary]
            .map(|scheme| self.automatic(scheme, AutoOr::Auto))
    }

    /// Simulation of one revolution from rest, with as many samples as the service takes.
    pub(crate) fn simulation<'a>(
        &'a self,
        stepping: Stepping,
        casing: &'a Casing,
        sensors: &'a [SensorRow],
    ) -> Simulation<'a> {
        let Stepping { scheme, steps } = stepping;
        Simulation {
            wheel: &self.modal,
            contact_nodes: &self.reduced.wheel.contact,
            damping: Some(&self.damping),
            casing: Some(casing),
            effects: Effects::default(),
            initial: &[],
            scheme,
            sensors,
            steps_per_revolution: steps,
            samples_per_revolution: (192..steps).find(|s| steps.is_multiple_of(*s)).unwrap_or(steps),
            revolutions: 1,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
    }
}

/// Sensor of the radial displacement of a contact node.
pub(crate) fn radial(node: usize, sector: usize) -> SensorRow {
    SensorRow { direction: Direction { node, components: [1.0, 0.0, 0.0] }, sector }
}

/// Name of a scheme in the words of the service.
pub(crate) fn name(scheme: Scheme) -> String {
    match scheme {
        Scheme::CentralDifferences => "`central_differences`".into(),
        Scheme::ExactModal => "`exact_modal`".into(),
        Scheme::MasslessBoundary { kept_modes } => format!("`massless_boundary`, {kept_modes} modes"),
    }
}
