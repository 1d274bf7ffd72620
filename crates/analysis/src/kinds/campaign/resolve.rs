//! Campaigns, checked against their models.

use crate::effects::casing::request::Measured;
use crate::error::Violation;
use crate::kinds::campaign::designs::{added, designs, levels};
use crate::kinds::campaign::resolved::{changed, written as written_out};
use crate::model::ModelFacts;
use crate::request::sweep::default_peak_prominence;
use crate::request::{
    CampaignRequest, CampaignSettings, Design, DesignKind, DistributionKind, Parameter, Record, Sensor,
    Severity, SweepDirection, SweepRequest, Threshold,
};
use crate::resolve::findings::Findings;
use crate::resolve::resolve_sweep;
use crate::resolved::{Distribution, ResolvedCampaign, ResolvedSweep};
use crate::result::severity_column;
use rubmap_wheel::dynamics::sector::Units;

/// Largest number of parameters of a campaign: Sobol points have directions for twice as many and more.
const PARAMETERS: usize = 100;

/// Largest number of designs of a campaign, and of simulations, each of which is stored.
const DESIGNS: usize = 10_000;
const SIMULATIONS: u64 = 100_000;

/// Largest number of measured heights over all designs that change some of them.
const HEIGHTS: usize = 1_000_000;

/// Largest number of refused designs that are reported.
const TOLD: usize = 20;

/// Model that a campaign compares with its own.
#[derive(Debug, Clone)]
pub(crate) struct ComparedModel {
    /// Facts of the model.
    pub facts: ModelFacts,
    /// Sensors asked for, at nodes of this model.
    pub sensors: Vec<Sensor>,
}

/// Parses a campaign and checks its unchanged scene against its models; its designs are still to be checked. `compared` is the model of
/// `compared_model`, if there is one.
pub(crate) fn resolve_campaign(
    request: CampaignRequest,
    facts: ModelFacts,
    compared: Option<ComparedModel>,
) -> Result<CampaignDesigns, Vec<Violation>> {
    let CampaignRequest { parameters, design, severity, limit, threshold, stress, scene, .. } = request;
    let asked = SweepRequest {
        model: request.model,
        modes_per_speed: request.modes_per_speed,
        speeds: request.speeds,
        scene: scene.clone(),
        integration: request.integration,
        sensors: request.sensors,
        max_engine_order: request.max_engine_order,
        peak_prominence: default_peak_prominence(),
        sweep: SweepDirection::Independent,
        refine: Some(false),
        reproducible: false,
        accuracy: None,
        budget: None,
        control_speeds: None,
        record: Record { stress, ..Record::default() },
        fields: request.fields,
        operation: None,
        limits: None,
        blade_thickness: None,
    };
    let mut found = Findings::default();
    let other = request.compared_model.zip(compared.as_ref()).map(|(model, compared)| {
        let sweep = SweepRequest { model, sensors: compared.sensors.clone(), ..asked.clone() };
        (sweep, &compared.facts)
    });
    found.require(
        other.as_ref().is_none_or(|(sweep, _)| sweep.model != asked.model),
        "/compared_model",
        "the id of another model than `model`",
    );
    let resolved = resolve_sweep(asked, &facts)
        .map_err(|violations| found.0.extend(violations.into_iter().map(at_its_field)));
    let other = other.map(|(sweep, others)| check_compared(&mut found, sweep, (&facts, others))).transpose();
    let distributions = check_parameters(&mut found, &parameters, &design);
    check_names(&mut found, &parameters, severity, &facts.units);
    check_design(&mut found, &design, &parameters, &distributions);
    check_threshold(&mut found, threshold.as_ref(), limit, &parameters, &distributions);
    found.require(limit.is_none_or(f64::is_finite), "/limit", "a finite number");
    let (Ok(sweep), Ok(other)) = (resolved, other) else { return Err(found.0) };
    check_severity(&mut found, severity, &sweep);
    if !found.0.is_empty() {
        return Err(found.0);
    }
    let drawn: Vec<Distribution> = distributions.iter().flatten().cloned().collect();
    let (size, seed) = (design.size.unwrap_or(0) as usize, design.seed.unwrap_or(0));
    let values = match &design.points {
        Some(points) => points.clone(),
        None => designs(design.kind, (size, seed), &parameters, &drawn),
    };
    // The scene as it was written, since pointers lead into it.
    let written = |sweep: &ResolvedSweep| SweepRequest { scene: scene.clone(), ..sweep.clone().into() };
    let settings = CampaignSettings {
        sweep: written(&sweep),
        compared: other.as_ref().map(written),
        parameters,
        design,
        severity,
        limit,
        threshold,
        designs: values,
        added: 0,
    };
    check_simulations(&mut found, &settings, sweep.speeds.count());
    if !found.0.is_empty() {
        return Err(found.0);
    }
    let measured = sweep.scene.casing.as_ref().and_then(|casing| casing.shape.measured.clone());
    let measured = measured.filter(|_| !settings.parameters.iter().any(moves_heights));
    let without_table = |sweep: &SweepRequest| {
        let mut sweep = sweep.clone();
        if let Some(casing) = sweep.scene.casing.as_mut().filter(|_| measured.is_some()) {
            casing.measured = None;
        }
        written_out(&sweep)
    };
    let mut models = vec![(without_table(&settings.sweep)?, facts)];
    if let (Some(sweep), Some(compared)) = (&settings.compared, compared) {
        models.push((without_table(sweep)?, compared.facts));
    }
    let laid_out = settings.designs.iter().cloned().enumerate();
    let designs: Vec<_> = laid_out.chain(that_may_be_added(&settings, &distributions)).collect();
    let campaign = ResolvedCampaign { sweep, compared: other, distributions, settings };
    check_work(&mut found, &campaign.settings, designs.len() * models.len());
    if !found.0.is_empty() {
        return Err(found.0);
    }
    Ok(CampaignDesigns { campaign, models, measured, designs, checked: 0, found })
}

/// Campaign whose designs are checked one at a time, so that whoever resolves it can do other work between two of them, or give up.
#[derive(Debug)]
pub(crate) struct CampaignDesigns {
    campaign: ResolvedCampaign,
    /// Sweep of every model, written out without the table that all designs share, and facts of the model.
    models: Vec<(serde_json::Value, ModelFacts)>,
    /// Measured heights of the casing, where no parameter changes them.
    measured: Option<Measured>,
    /// Index and values of every design: those laid out, then those that may be added, at both ends of the threshold's parameter.
    designs: Vec<(usize, Vec<f64>)>,
    /// Designs checked so far, counted once for every model.
    checked: usize,
    found: Findings,
}

impl CampaignDesigns {
    /// Checks the next design of a model; `false` if none was left. A violation is reported at the parameter that changes the field, if one
    /// does.
    pub(crate) fn check_next(&mut self) -> bool {
        let (model, design) =
            (self.checked / self.designs.len().max(1), self.checked % self.designs.len().max(1));
        let (Some((sweep, facts)), Some((index, values))) =
            (self.models.get(model), self.designs.get(design))
        else {
            return false;
        };
        if self.found.0.len() >= TOLD {
            return false;
        }
        let parameters = &self.campaign.settings.parameters;
        let checked = changed(sweep.clone(), parameters, values).and_then(|mut sweep| {
            if let (Some(casing), Some(measured)) = (&mut sweep.scene.casing, &self.measured) {
                casing.measured = Some(measured.clone());
            }
            resolve_sweep(sweep, facts).map(drop)
        });
        tell_of_design(&mut self.found, parameters, checked, *index, values);
        self.checked += 1;
        true
    }

    /// Campaign all of whose designs were checked.
    ///
    /// # Errors
    /// Violations of the designs.
    pub(crate) fn finish(self) -> Result<ResolvedCampaign, Vec<Violation>> {
        self.found.finish(self.campaign)
    }
}

/// Requires that neither the designs nor those that may be added need more simulations than are stored.
fn check_simulations(found: &mut Findings, settings: &CampaignSettings, speeds: u32) {
    let (designs, models) = (settings.designs_at_most(), if settings.compared.is_some() { 2 } else { 1 });
    let simulations = u64::from(designs) * models * u64::from(speeds);
    let grows = designs as usize > settings.designs.len();
    found.require(
        simulations <= SIMULATIONS,
        if grows { "/threshold/most_designs" } else { "/speeds" },
        format!(
            "{designs} designs{} over {speeds} speeds are {simulations} simulations, more than {SIMULATIONS}",
            if models > 1 { " of two models" } else { "" },
        ),
    );
    found.require(
        settings
            .sought()
            .is_none_or(|(threshold, _)| threshold.most_designs as usize >= settings.designs.len()),
        "/threshold/most_designs",
        format!("the design has {} already: none could be added", settings.designs.len()),
    );
}

/// Resolves the same sweep for the compared model; a violation of that model only names it in its message.
fn check_compared(
    found: &mut Findings,
    sweep: SweepRequest,
    (facts, others): (&ModelFacts, &ModelFacts),
) -> Result<ResolvedSweep, ()> {
    found.require(
        facts.units == others.units,
        "/compared_model",
        format!(
            "its units are {}, those of the other {}: only what is in the same units can be compared",
            in_words(&others.units),
            in_words(&facts.units)
        ),
    );
    let told = found.0.clone();
    resolve_sweep(sweep, others).map_err(|violations| {
        let own = violations.into_iter().map(at_its_field).filter(|violation| !told.contains(violation));
        found.0.extend(own.map(|violation| Violation {
            message: format!("of the model that is compared: {}", violation.message),
            ..violation
        }));
    })
}

fn in_words(units: &Units) -> String {
    [&units.mass, &units.length, &units.time, &units.force].map(String::as_str).join("-")
}

/// Moves a violation within `record` of a sweep to the campaign's own field.
fn at_its_field(violation: Violation) -> Violation {
    match violation.pointer.strip_prefix("/record") {
        Some(pointer) => Violation { pointer: pointer.to_owned(), ..violation },
        None => violation,
    }
}

fn check_parameters(
    found: &mut Findings,
    parameters: &[Parameter],
    design: &Design,
) -> Vec<Option<Distribution>> {
    found.require(
        (1..=PARAMETERS).contains(&parameters.len()),
        "/parameters",
        format!("between 1 and {PARAMETERS} parameters"),
    );
    let mut distributions = Vec::new();
    for (index, parameter) in parameters.iter().enumerate() {
        let at = |field: &str| format!("/parameters/{index}{field}");
        found.require(
            (1..=64).contains(&parameter.name.chars().count()),
            &at("/name"),
            "a name of 1 to 64 characters",
        );
        found.require(
            parameters[..index].iter().all(|other| other.name != parameter.name),
            &at("/name"),
            "another parameter is called so",
        );
        found.require((1..=100).contains(&parameter.at.len()), &at("/at"), "between 1 and 100 pointers");
        found.require(
            parameter.levels.is_none() || design.kind == DesignKind::Grid,
            &at("/levels"),
            "only a grid has levels: leave this away, or let the design be a grid",
        );
        match Distribution::of(parameter) {
            Ok(distribution) => {
                found.require(
                    distribution.is_some() || design.kind == DesignKind::List,
                    &at("/from"),
                    "say how the values are distributed: from and to, or another distribution",
                );
                distributions.push(distribution);
            }
            Err(violations) => {
                let placed =
                    |violation: Violation| Violation { pointer: at(&violation.pointer), ..violation };
                found.0.extend(violations.into_iter().map(placed));
                distributions.push(None);
            }
        }
    }
    distributions
}

/// Reserved names: columns of tables and arrays of results beside those of parameters, in all units of speed.
const COLUMNS: [&str; 24] = [
    "design",
    "severity",
    "worst_speed_rad_s",
    "worst_speed_rpm",
    "worst_speed_hz",
    "meets_limit",
    "finished",
    "diverged",
    "failed",
    "not_settled",
    "speeds_rad_s",
    "speeds_rpm",
    "speeds_hz",
    "speed_rpm",
    "by_speed",
    "parameter",
    "first_order",
    "first_order_error",
    "total",
    "total_error",
    "threshold",
    "comparison",
    "settings",
    "version",
];

/// Requires names of parameters that can be columns of tables and entries of archives.
fn check_names(found: &mut Findings, parameters: &[Parameter], severity: Severity, units: &Units) {
    let column = severity_column(severity, units);
    // Tables for spreadsheets have lengths in micrometres.
    let what = ["_mm", "_m"].iter().find_map(|unit| column.strip_suffix(unit));
    let as_read = what.map(|what| format!("{what}_um"));
    for (index, Parameter { name, .. }) in parameters.iter().enumerate() {
        let taken = COLUMNS.contains(&name.as_str()) || *name == column || Some(name) == as_read.as_ref();
        found.require(
            !taken && !name.starts_with("compared_"),
            &format!("/parameters/{index}/name"),
            "a column of the results is called so: choose another",
        );
        found.require(
            !name.contains(['/', '\\', '\u{fffe}', '\u{ffff}'])
                && !name.contains(char::is_control)
                && !name.trim().is_empty(),
            &format!("/parameters/{index}/name"),
            "a column of tables and archives is called so: not blank, no slashes, no control characters",
        );
    }
}

fn check_design(
    found: &mut Findings,
    design: &Design,
    parameters: &[Parameter],
    distributions: &[Option<Distribution>],
) {
    let sized = matches!(design.kind, DesignKind::LatinHypercube | DesignKind::Sobol | DesignKind::Indices);
    found.require(
        design.size.is_some() == sized,
        "/design/size",
        if sized { "say how many" } else { "this design has as many as it says: leave this away" },
    );
    let listed = design.kind == DesignKind::List;
    found.require(
        design.points.is_some() == listed,
        "/design/points",
        if listed {
            "say which"
        } else {
            "only a list has points: leave this away, or let the design be a list"
        },
    );
    for (index, point) in design.points.iter().flatten().enumerate().take(DESIGNS) {
        found.require(
            point.len() == parameters.len() && point.iter().all(|value| value.is_finite()),
            &format!("/design/points/{index}"),
            format!("{} finite numbers, one per parameter", parameters.len()),
        );
    }
    let mut count = match design.kind {
        DesignKind::List => design.points.as_ref().map_or(1.0, |points| points.len() as f64),
        DesignKind::LatinHypercube | DesignKind::Sobol => design.size.unwrap_or(1).into(),
        DesignKind::Indices => f64::from(design.size.unwrap_or(1)) * (parameters.len() + 2) as f64,
        DesignKind::Grid => 1.0,
    };
    if design.kind == DesignKind::Grid {
        for (index, (parameter, distribution)) in parameters.iter().zip(distributions).enumerate() {
            let Some(distribution) = distribution else { continue };
            count *= levels(parameter, distribution);
            let at = format!("/parameters/{index}/levels");
            let given = parameter.levels.is_some();
            let own = distribution.own_levels().is_some();
            found.require(
                given != own,
                &at,
                if own {
                    "all of its values are taken: leave this away"
                } else {
                    "a grid needs to know how many"
                },
            );
            found.require(parameter.levels != Some(0), &at, "at least 1");
            let (from, to) = distribution.range();
            found.require(
                from.is_finite() && to.is_finite(),
                &format!("/parameters/{index}/from"),
                "a grid reaches from `from` to `to`: give both",
            );
        }
    }
    found.require(
        (1.0..=DESIGNS as f64).contains(&count),
        "/design",
        format!("{count} designs: between 1 and {DESIGNS}"),
    );
}

fn check_threshold(
    found: &mut Findings,
    threshold: Option<&Threshold>,
    limit: Option<f64>,
    parameters: &[Parameter],
    distributions: &[Option<Distribution>],
) {
    let Some(threshold) = threshold else { return };
    found.require(limit.is_some(), "/limit", "a threshold is where a limit is met: give one");
    found.require(
        (1e-6..=1.0 - 1e-6).contains(&threshold.probability),
        "/threshold/probability",
        "between 0.000001 and 0.999999",
    );
    found.require(
        (1..=DESIGNS as u32).contains(&threshold.batch),
        "/threshold/batch",
        format!("between 1 and {DESIGNS}"),
    );
    found.require(
        (1..=DESIGNS as u32).contains(&threshold.most_designs),
        "/threshold/most_designs",
        format!("between 1 and {DESIGNS}"),
    );
    let index = parameters.iter().position(|parameter| parameter.name == threshold.parameter);
    found.require(index.is_some(), "/threshold/parameter", "the name of one of the parameters");
    let (Some(index), Some(within)) = (index, threshold.within) else { return };
    found.require(within.is_finite() && within > 0.0, "/threshold/within", "a finite number above 0");
    found.require(
        distributions.iter().all(Option::is_some),
        "/threshold/within",
        "designs are added from the distributions of the parameters: give one for each, or leave this away",
    );
    if let Some(Some(distribution)) = distributions.get(index) {
        let (from, to) = distribution.range();
        found.require(
            from.is_finite() && to.is_finite(),
            &format!("/parameters/{index}/from"),
            "designs are added between `from` and `to`: give both",
        );
        found.require(
            within < to - from,
            "/threshold/within",
            "less than the parameter's range, which is known to so much already",
        );
        found.require(
            distribution.is_continuous() && parameters[index].distribution != DistributionKind::Values,
            "/threshold/within",
            "designs can be added between others only where the parameter takes every value: leave this away",
        );
    }
}

fn check_severity(found: &mut Findings, severity: Severity, sweep: &ResolvedSweep) {
    let (there, needs) = match severity {
        Severity::Amplitude | Severity::Tip => return,
        Severity::ContactForce => {
            (sweep.scene.contact.is_some(), "contact: write \"contact\": {} in the scene")
        }
        Severity::Wear => (sweep.scene.abradable.is_some(), "a coating: write \"abradable\" in the scene"),
        Severity::Stress | Severity::Utilisation => (
            sweep.record.stress.is_some(),
            "stress: ask for it by \"stress\": {}, which needs a model with a mesh",
        ),
    };
    found.require(there, "/severity", format!("there is none without {needs}"));
}

/// Whether a parameter changes measured heights of the casing.
fn moves_heights(parameter: &Parameter) -> bool {
    parameter.at.iter().any(|at| at.starts_with("/scene/casing/measured/"))
}

/// Limits the measured heights of all designs together: a design that changes some of them costs as much work as all its heights.
fn check_work(found: &mut Findings, settings: &CampaignSettings, designs: usize) {
    let Some(index) = settings.parameters.iter().position(moves_heights) else { return };
    let casing = settings.sweep.scene.casing.as_ref();
    let heights = casing
        .and_then(|casing| casing.measured.as_ref())
        .map_or(0, |measured| measured.heights.iter().map(Vec::len).sum::<usize>());
    found.require(
        designs * heights <= HEIGHTS,
        &format!("/parameters/{index}/at"),
        format!(
            "{designs} designs that change measured heights, those that may be added and those of a second model included, have {heights} \
             heights each, more than {HEIGHTS} together: ask for fewer designs, measure at fewer angles, or change the casing by lobes \
             and waves beside the table"
        ),
    );
}

/// Reports the violations of design `index`.
fn tell_of_design(
    found: &mut Findings,
    parameters: &[Parameter],
    checked: Result<(), Vec<Violation>>,
    index: usize,
    values: &[f64],
) {
    for violation in checked.err().unwrap_or_default() {
        let moves = |parameter: &Parameter| {
            let within = |at: &String| at.starts_with(&violation.pointer);
            !violation.pointer.is_empty() && parameter.at.iter().any(within)
        };
        let pointer = match parameters.iter().position(moves) {
            _ if violation.pointer.starts_with("/parameters") => violation.pointer.clone(),
            Some(parameter) => format!("/parameters/{parameter}"),
            None => "/design".to_owned(),
        };
        if !found.refused(&pointer) {
            let said = parameters
                .iter()
                .zip(values)
                .map(|(parameter, value)| format!("{} = {value}", parameter.name));
            let said = said.collect::<Vec<_>>().join(", ");
            found.0.push(Violation::new(
                pointer,
                format!("design {index} ({said}), {}: {}", violation.pointer, violation.message),
            ));
        }
    }
}

/// Indices and values of designs that may be added for a threshold, each with the parameter of the threshold at either end; all other
/// values are final.
fn that_may_be_added(
    settings: &CampaignSettings,
    distributions: &[Option<Distribution>],
) -> Vec<(usize, Vec<f64>)> {
    let all: Option<Vec<&Distribution>> = distributions.iter().map(Option::as_ref).collect();
    let (Some((threshold, _)), Some(distributions)) = (settings.sought(), all) else { return Vec::new() };
    let Some(index) = settings.parameter(&threshold.parameter) else { return Vec::new() };
    let (from, to) = distributions[index].range();
    let seed = settings.design.seed.unwrap_or(0);
    let ends = |design: usize| {
        let values = added(design, seed, &distributions);
        [from, to].map(|end| {
            let mut values = values.clone();
            values[index] = end;
            (design, values)
        })
    };
    (settings.designs.len()..threshold.most_designs as usize).flat_map(ends).collect()
}
