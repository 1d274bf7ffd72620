"""Requests and answers of the contract, openapi.yaml: made by generate_contract.py."""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypeAlias
from typing_extensions import TypedDict


class Abradable(TypedDict, closed=True):
    hardening: float
    modulus: float
    rods_around: NotRequired[int]
    thickness: float
    yield_stress: float


class AbsoluteFrequencies(TypedDict):
    frequencies_hz: list[list[list[float]]]
    superharmonic: int


AccuracyOf: TypeAlias = Literal["response", "stress"]


class AngularGap(TypedDict):
    from_rad: float
    to_rad: float


ArchiveZip: TypeAlias = bytes


class AssemblyPrice(TypedDict):
    memory_bytes: int
    package_bytes: int
    seconds: float
    unknowns: int


AutoOr: TypeAlias = Literal["auto"] | int


class BackbonePoint(TypedDict):
    amplitude: float
    change_percent: float
    frequency_hz: float
    harmonics_percent: float


class BackbonesRequest(TypedDict, closed=True):
    coordinates: NotRequired[int]
    largest_amplitude: NotRequired[float | None]
    nodal_diameters: NotRequired[list[int]]


Bending: TypeAlias = Literal["kinematics", "full"]


BifurcationKind: TypeAlias = Literal["fold", "flip", "neimark_sacker", "branching"]


class BranchEnd1(TypedDict):
    why: Literal["leaves_range"]


class BranchEnd2(TypedDict):
    why: Literal["most_points"]


class BranchEnd3(TypedDict):
    why: Literal["joins"]


class BranchEnd4(TypedDict):
    reason: str
    why: Literal["lost"]


BranchEnd: TypeAlias = BranchEnd1 | BranchEnd2 | BranchEnd3 | BranchEnd4


BranchParameter: TypeAlias = Literal["speed", "clearance", "lobe_amplitude", "damping"]


class Budget(TypedDict, closed=True):
    seconds: float


class CasingMode(TypedDict, closed=True):
    frequency_hz: float
    modal_mass: float
    nodal_diameter: int


CasingTable: TypeAlias = str


Change: TypeAlias = Literal["set", "add", "multiply"]


class Check(TypedDict):
    detail: str
    name: str
    value: NotRequired[float]


class ClearanceAt(TypedDict, closed=True):
    change: float
    revolutions: float


class ClearanceChange(TypedDict, closed=True):
    along_chord: NotRequired[list[float] | None]
    course: list[ClearanceAt]


ClearanceState: TypeAlias = Literal["running", "cold"]


class Coincidence(TypedDict):
    casing_frequency_hz: float
    casing_nodal_diameter: int
    family: int
    frequency_hz: float
    nodal_diameter: int
    speed_rad_s: float
    sum: bool


Component: TypeAlias = Literal["radial", "tangential", "axial", "normal"]


class Contact(TypedDict, closed=True):
    pass


class ContactForces(TypedDict):
    clearance_consumption: list[list[float]]
    closings_per_revolution: list[list[float]]
    contact_share: list[list[float]]
    impulse_per_revolution: list[list[float]]
    linear_clearance_consumption: list[float]
    peak_force: list[list[float]]


class ContactHistory(TypedDict):
    contact_length: NotRequired[list[float]]
    force: NotRequired[list[list[list[float]]]]
    nodes_in_contact: NotRequired[list[float]]


class ContactPlace(TypedDict):
    clearance: NotRequired[float]
    heights: NotRequired[list[float]]
    id: int
    normal: list[float]
    position: list[float]


class ContactSummary(TypedDict):
    clearance_consumption: float
    clearance_contact_node: int
    closings_per_revolution: float
    linear_clearance_consumption: NotRequired[float]
    mean_force: float
    peak_contact_node: NotRequired[int]
    peak_force: float
    peak_node_force: float
    peak_sector: NotRequired[int]
    samples_per_revolution: int
    worst_sector: NotRequired[int]


class Cost(TypedDict):
    per_revolution_s: float
    repetitions: int
    set_up_s: float
    spread: NotRequired[float]


class CostRange(TypedDict):
    contact: float
    free: float


Course: TypeAlias = Literal["crosses", "exchanges", "stays"]


class Crossing(TypedDict):
    family: int
    frequency_hz: float
    nodal_diameter: int
    speed_rad_s: float
    superharmonic: int


DesignKind: TypeAlias = Literal["grid", "list", "latin_hypercube", "sobol", "indices"]


class DesignOutcome(TypedDict):
    by_speed: list[float | None]
    diverged: int
    failed: int
    finished: int
    meets_limit: NotRequired[bool]
    message: NotRequired[str]
    not_settled: NotRequired[int]
    severity: NotRequired[float]
    worst_speed_rad_s: NotRequired[float]


DifferenceVerdict: TypeAlias = Literal["greater", "smaller", "undecided"]


class DigitNoise(TypedDict):
    has_all_digits: NotRequired[bool]
    residual: float
    square_rad2_s2: float


DistributionKind: TypeAlias = Literal[
    "uniform", "log_uniform", "normal", "triangular", "whole", "values"
]


ElementOrder: TypeAlias = Literal["linear", "quadratic"]


class EnergyHistory(TypedDict):
    bending_work: NotRequired[list[float]]
    casing_loss: NotRequired[list[float]]
    casing_work: NotRequired[list[float]]
    contact_work: list[float]
    damping_loss: list[float]
    excitation_work: NotRequired[list[float]]
    friction_heat: NotRequired[list[float]]
    initial: float
    mechanical: list[float]
    mistuning_work: NotRequired[list[float]]


class EnergyReport(TypedDict):
    bending_residual: NotRequired[float]
    bending_work: NotRequired[float]
    casing_loss: NotRequired[float]
    casing_work: NotRequired[float]
    contact_work: float
    damping_loss: float
    excitation_work: NotRequired[float]
    final: float
    friction_heat: NotRequired[float]
    initial: float
    mistuning_work: NotRequired[float]


ContactNode: TypeAlias = int


class EngineOrderExcitation(TypedDict, closed=True):
    amplitude: float
    component: Component
    contact_nodes: list[ContactNode]
    order: int
    phase_rad: NotRequired[float]


class Errors(TypedDict):
    amplitude: float
    amplitude_spread: NotRequired[float]
    engine_orders: NotRequired[float]
    history: NotRequired[float]
    impulse: NotRequired[float]
    stress: NotRequired[float]


class Estimate(TypedDict):
    computing_time_s: CostRange
    memory_bytes: int
    speed_memory_bytes: NotRequired[int]
    steps: int
    wall_time_s: CostRange
    workers: int


FamiliesBy: TypeAlias = Literal["shape", "rank"]


class FatigueStrength(TypedDict, closed=True):
    amplitude: float
    source: str


class Figure(TypedDict):
    data: list[dict[str, Any]]
    layout: dict[str, Any]


class FilledHeight(TypedDict):
    angle_rad: float
    height: float
    line: int


class FloquetMultiplier(TypedDict):
    imaginary: float
    modulus: float
    nodal_diameter: int
    order_offset: float
    real: float
    residual: float
    share: float


class ForceRow(TypedDict):
    clearance_consumption: list[float]
    closings_per_revolution: list[float]
    contact_share: list[float]
    impulse_per_revolution: list[float]
    linear_clearance_consumption: NotRequired[list[float]]
    peak_force: list[float]
    summary: ContactSummary
    worst_sector: list[int | None]


class FoundSymmetry(TypedDict):
    moving_nodal_diameters: list[int]
    repeats: int
    resting_nodal_diameters: list[int]


FrictionLaw: TypeAlias = Literal["sliding", "disc"]


Node: TypeAlias = int


class Gauge(TypedDict, closed=True):
    at: NotRequired[list[float] | None]
    direction: NotRequired[list[float] | None]
    length: NotRequired[float | None]
    nodes: NotRequired[list[Node] | None]


class GaugeEnd(TypedDict):
    length: float
    node: int
    position: list[float]


class GeometricNonlinearity(TypedDict, closed=True):
    coordinates: NotRequired[int]
    include: Bending


class GivenStrengths(TypedDict, closed=True):
    fatigue_strength: NotRequired[FatigueStrength | None]
    ultimate_strength: NotRequired[float | None]
    yield_strength: NotRequired[float | None]


ModesPerSpeedItem: TypeAlias = int


StepsPerRevolutionItem: TypeAlias = int


Growth: TypeAlias = Literal["chaotic", "quasi_periodic", "stable", "undecided"]


class Health(TypedDict):
    memory_bytes: NotRequired[int]
    status: str
    version: str


Revolution: TypeAlias = int


HistorySpeeds: TypeAlias = Literal["critical"] | list[int]


InitialWave: TypeAlias = Literal["standing", "forward", "backward"]


class JobEvent(TypedDict):
    data: str
    event: str


JobKind: TypeAlias = Literal[
    "sweep",
    "modal_analysis",
    "case_study",
    "branches",
    "run_up",
    "campaign",
    "study",
    "model_generation",
]


JobStatus: TypeAlias = Literal[
    "accepted", "running", "paused", "successful", "failed", "dismissed"
]


class LabelPatch(TypedDict, closed=True):
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    tags: NotRequired[list[str] | None]


class LargestDifference(TypedDict):
    full_hz: float
    mode: int
    nodal_diameter: int
    relative: float


class LargestOfRun(TypedDict):
    displacement: float
    speed_rad_s: float
    time_s: float


class LeadingPlace(TypedDict):
    node: int
    set: str
    von_mises: float


LimitKind: TypeAlias = Literal[
    "clearance_consumption", "tip_motion", "utilisation", "node_force"
]


class Limits(TypedDict, closed=True):
    clearance_consumption: NotRequired[float | None]
    node_force: NotRequired[float | None]
    tip_motion: NotRequired[float | None]
    utilisation: NotRequired[float | None]


class LimitsMet(TypedDict):
    both: int
    neither: int
    only_compared: int
    only_model: int


class Link(TypedDict):
    href: str
    rel: str


class Lobes(TypedDict, closed=True):
    along_chord: NotRequired[list[float] | None]
    amplitude: float
    count: int
    phase_rad: NotRequired[float]
    width_rad: float


LookStep: TypeAlias = Literal[
    "materials", "mesh", "sectors", "clamp", "contact", "memory"
]


class Machine(TypedDict):
    name: str
    processor: str
    processors: int
    vectors: str


class MarchReport(TypedDict):
    period_revolutions: NotRequired[int]
    reason: NotRequired[str]
    remaining_change: NotRequired[float]
    revolutions: int


MassRule: TypeAlias = Literal["consistent", "as_stiffness"]


class Material(TypedDict, closed=True):
    density: NotRequired[float]
    fatigue_strength: NotRequired[FatigueStrength | None]
    poissons_ratio: NotRequired[float]
    ultimate_strength: NotRequired[float | None]
    yield_strength: NotRequired[float | None]
    youngs_modulus: NotRequired[float]


class MaterialInSi(TypedDict):
    density_kg_m3: float
    set: str
    wave_speed_m_s: float
    youngs_modulus_pa: float


class Measured(TypedDict, closed=True):
    angles_rad: list[float]
    chord: NotRequired[list[float] | None]
    heights: list[list[float]]


MeshBytes: TypeAlias = bytes


class MeshChain(TypedDict):
    cyclic: bool
    length: float
    nodes: list[int]


class MeshDensities(TypedDict, closed=True):
    between_contact_nodes: NotRequired[int]
    blade_height: NotRequired[int]
    blade_thickness: NotRequired[int]
    disk: NotRequired[int]
    half_passage: NotRequired[int]


MeshRole: TypeAlias = Literal["low", "high", "clamp", "contact"]


class Mistuning(TypedDict, closed=True):
    deviations: NotRequired[list[float] | None]
    seed: NotRequired[int | None]
    spread: NotRequired[float | None]


Superharmonic: TypeAlias = int


class NearestOrder(TypedDict):
    engine_order: int
    frequency_hz: float
    margin_percent: float


NodeKind: TypeAlias = Literal["internal", "low", "high", "contact", "clamped"]


OpenKind: TypeAlias = Literal[
    "no_limit",
    "range_not_covered",
    "speeds_missing",
    "speeds_failed",
    "not_settled",
    "unsound_stiffness",
    "beyond_linear_theory",
    "linear_theory_not_checked",
    "error_across_limit",
    "error_unknown",
    "value_unknown",
    "peak_unresolved",
    "nothing_touches",
]


class OpenQuestion(TypedDict):
    finding: str
    range: NotRequired[str]
    remedy: str
    speeds: NotRequired[list[int]]
    what: OpenKind


class Orbit(TypedDict, closed=True):
    phase_rad: NotRequired[float]
    radius: float
    whirl_ratio: NotRequired[float]


class Outlier(TypedDict):
    angle_rad: float
    expected: float
    height: float
    line: int


class Overshoot(TypedDict):
    angle_rad: float
    by: float
    line: int


PackageZip: TypeAlias = bytes


Parameter = TypedDict(
    "Parameter",
    {
        "at": list[str],
        "change": NotRequired[Change],
        "distribution": NotRequired[DistributionKind],
        "from": NotRequired[float | None],
        "levels": NotRequired[int | None],
        "mean": NotRequired[float | None],
        "mode": NotRequired[float | None],
        "name": str,
        "standard_deviation": NotRequired[float | None],
        "to": NotRequired[float | None],
        "values": NotRequired[list[float] | None],
    },
    closed=True,
)


class ParameterSensitivity(TypedDict):
    first_order: float
    first_order_error: float
    parameter: str
    total: float
    total_error: float


class PassingRate(TypedDict):
    about_rad_s2: NotRequired[float]
    enough_rad_s2: NotRequired[float]
    limit: float
    message: str
    too_slow_rad_s2: NotRequired[float]


class PlacedSensor(TypedDict):
    angle_deg: NotRequired[float]
    asked_length: NotRequired[float]
    contact_node: NotRequired[int]
    distance: NotRequired[float]
    end: NotRequired[GaugeEnd]
    node: int
    position: list[float]
    sensor: int


class PlannedEffect(TypedDict):
    adds: NotRequired[str]
    name: str
    on: bool


class PointError(TypedDict):
    controlled: bool
    estimated_error: float
    estimated_stress_error: NotRequired[float]
    index: int


PointStatus: TypeAlias = Literal["completed", "diverged", "failed"]


Position: TypeAlias = Literal["inside", "within_separation", "outside"]


Preset: TypeAlias = Literal["small", "medium", "paper"]


class Probe(TypedDict, closed=True):
    amplitude: NotRequired[float]
    seed: NotRequired[int]


class ProblemItem(TypedDict):
    column: NotRequired[int]
    detail: str
    file: NotRequired[str]
    line: NotRequired[int]
    parameter: NotRequired[str]
    pointer: NotRequired[str]


Quantity: TypeAlias = Literal[
    "history", "amplitude", "engine_orders", "impulse", "stress"
]


class RangePosition(TypedDict):
    distance_percent: float
    position: Position
    range: str


class Readiness(Health):
    checks: list[Check]


class Receipt(TypedDict):
    id: str
    kind: JobKind
    links: list[Link]
    status: JobStatus


RecordedQuantity: TypeAlias = Literal[
    "displacement", "velocity", "contact_force", "contact", "energy", "state"
]


ReductionState: TypeAlias = Literal["stored", "to be computed"]


class Ring(TypedDict, closed=True):
    area: float
    density: float
    modulus: float
    n_max: NotRequired[int]
    radius: float
    second_moment: float


class RunUpFrame(TypedDict):
    contact_share: float
    half_peak_to_peak: list[float]
    largest: list[float]
    revolution: int
    speeds_rad_s: list[float]
    times_s: list[float]


SchemeChoice: TypeAlias = Literal[
    "auto", "central_differences", "exact_modal", "massless_boundary"
]


class SchemeReport(TypedDict):
    following_modes: int
    kept_modes: NotRequired[int]
    name: SchemeChoice
    reach_hz: float
    reason: str


class SectorNode(TypedDict):
    id: int
    kind: NodeKind
    position: list[float]


class Sensitivities(TypedDict):
    blocks: int
    mean: float
    parameters: list[ParameterSensitivity]
    variance: float


class Sensitivity(TypedDict):
    growth: NotRequired[Growth]
    last_distance: float
    rate_error: NotRequired[float]
    rate_from_revolution: NotRequired[int]
    rate_per_revolution: NotRequired[float]
    separated_after_revolutions: NotRequired[int]


class Sensor(TypedDict, closed=True):
    component: NotRequired[Component | None]
    contact_node: NotRequired[int | None]
    direction: NotRequired[list[float] | None]
    gauge: NotRequired[Gauge | None]
    nearest: NotRequired[list[float] | None]
    node: NotRequired[int | None]
    sector: NotRequired[int]


class SensorSpectrum(TypedDict):
    amplitude: list[float]
    nodal_diameters: list[list[float]]
    sensor: Sensor


class Setting(TypedDict):
    kept_modes: AutoOr
    modes_per_speed: int
    scheme: SchemeChoice
    steps_per_revolution: int


Severity: TypeAlias = Literal[
    "amplitude", "tip", "contact_force", "wear", "stress", "utilisation"
]


class ShapeFrequencies(TypedDict):
    frequencies_hz: list[float]
    nodal_diameter: int


class SideBands(TypedDict):
    carrier: float
    engine_order: int
    lower: float
    resolution: float
    spacing: float
    upper: float


class SingleLobe(TypedDict, closed=True):
    along_chord: NotRequired[list[float] | None]
    amplitude: float
    angle_rad: float
    width_rad: float


class SpeedCounts(TypedDict):
    diverged: int
    failed: int
    finished: int
    total: int


SpeedCourse: TypeAlias = Literal["straight", "smooth"]


class SpeedPoint(TypedDict, closed=True):
    speed: float
    time_s: float


class SpeedSpectra(TypedDict):
    engine_orders: list[float]
    sensors: list[SensorSpectrum]


SpeedUnit: TypeAlias = Literal["rad_s", "rpm", "hz"]


class Spent(TypedDict):
    computing_time_s: float
    steps: int


class Splitter(TypedDict, closed=True):
    leading_edge: NotRequired[float]


Stability: TypeAlias = Literal[
    "stable", "narrow", "flip", "fold", "neimark_sacker", "undecided"
]


Standing: TypeAlias = Literal["kept", "reached", "open", "passed"]


SteadyChoice: TypeAlias = Literal["march", "periodic", "auto"]


class SteadyReport(TypedDict):
    followed_from_damping: NotRequired[float]
    half_peak_to_peak: NotRequired[list[float]]
    lobe_passages: NotRequired[int]
    multipliers: NotRequired[list[FloquetMultiplier]]
    reason: NotRequired[str]
    residual: NotRequired[float]
    revolutions: float
    stability: NotRequired[Stability]
    taken: bool


class StepOrder(TypedDict):
    differences: list[float | None]
    kept_modes: AutoOr
    modes_per_speed: int
    orders: list[float | None]
    scheme: SchemeChoice
    steps_per_revolution: list[int]


StiffeningVerdict: TypeAlias = Literal["absent", "sound", "suspect", "unsound"]


Strengths = TypedDict(
    "Strengths",
    {
        "fatigue": NotRequired[float],
        "set": str,
        "source": NotRequired[str],
        "ultimate": NotRequired[float],
        "yield": NotRequired[float],
    },
)


class StressCycle(TypedDict):
    alternating: float
    mean: float
    node: int
    over_yield: NotRequired[float]
    position: list[float]
    principal_alternating: float
    principal_mean: float
    sector: int
    set: str
    utilisation: NotRequired[float]


class StressPeak(TypedDict):
    node: int
    position: list[float]
    revolution: float
    sector: int
    von_mises: float


class StressRequest(TypedDict, closed=True):
    excluded_radius: NotRequired[float | None]
    strengths: NotRequired[dict[str, GivenStrengths]]


class StudyIntegration(TypedDict, closed=True):
    ramp_revolutions: NotRequired[float]
    revolutions: NotRequired[int]
    steady: NotRequired[SteadyChoice]
    window_revolutions: NotRequired[int]


class StudyRecord(TypedDict, closed=True):
    stress: NotRequired[StressRequest | None]


class StudyReduction(TypedDict):
    modes_per_speed: int
    stiffening: NotRequired[StiffeningVerdict]
    wall_time_s: float
    wheel_unknowns: int


SweepDirection: TypeAlias = Literal["independent", "up", "down"]


Symmetry: TypeAlias = Literal["full", "exact", "probe"]


class SymmetryBreaking(TypedDict):
    broken_after_revolutions: NotRequired[int]
    energy_share: float
    grows: bool
    nodal_diameters: list[int]
    rate_error: NotRequired[float]
    rate_per_revolution: NotRequired[float]
    repeats: int


class Threshold(TypedDict, closed=True):
    batch: NotRequired[int]
    most_designs: NotRequired[int]
    parameter: str
    probability: NotRequired[float]
    within: NotRequired[float | None]


ThresholdShare = TypedDict(
    "ThresholdShare",
    {
        "designs": int,
        "expected": NotRequired[float],
        "from": float,
        "met": int,
        "to": float,
    },
)


class Tilt(TypedDict, closed=True):
    about_z: NotRequired[float]
    angle_rad: float
    towards_rad: NotRequired[float]


class TipPlace(TypedDict):
    angle_rad: float
    clearance: float
    heights: NotRequired[list[float]]


class TipResponse(TypedDict):
    component: Component
    contact_node: int
    half_peak_to_peak: float
    largest_half_peak_to_peak: NotRequired[float]
    over_chord: NotRequired[float]
    over_clearance: NotRequired[float]
    rms: float
    sector: int


class Track(TypedDict):
    branch: int
    doubles: NotRequired[list[int | float] | None]
    lobe_passages: NotRequired[int]


class TriedModes(TypedDict):
    error: float
    modes_per_speed: int
    wall_time_s: float


class Units(TypedDict, closed=True):
    force: str
    length: str
    mass: str
    time: str


Unresolvable: TypeAlias = Literal["end_of_range", "beside_missing", "too_coarse"]


class Unresolved(TypedDict):
    reason: Unresolvable
    sensor: NotRequired[int]
    speed_rad_s: float


ValidityMeasure: TypeAlias = Literal[
    "excess_energy",
    "second_order_gap",
    "outside_coordinates",
    "displacement_over_thickness",
    "displacement_over_chord",
    "rotation",
    "stress_over_yield",
    "neighbour_approach",
    "contact_over_lobe",
]


ValidityVerdict: TypeAlias = Literal["linear", "not_checked", "doubtful", "beyond"]


class Veering(TypedDict):
    course: Course
    distance_hz: float
    families: list[int]
    frequency_hz: float
    nodal_diameter: int
    speed_rad_s: float


Verdict: TypeAlias = Literal["periodic", "subharmonic", "aperiodic", "not_settled"]


VerdictWord: TypeAlias = Literal["clear", "watch", "undecided", "act"]


class Version(TypedDict):
    commit: str
    profile: str
    target: str
    target_features: list[str]
    version: str


class Wave(TypedDict, closed=True):
    along_chord: NotRequired[list[float] | None]
    amplitude: float
    order: int
    phase_rad: NotRequired[float]


class WaveTables(TypedDict):
    backward_hz: list[list[list[float]]]
    forward_hz: list[list[list[float]]]


class WearMap(TypedDict):
    depths: list[list[float]]


class WearReport(TypedDict):
    deepest: float
    plastic_work: float
    reached_metal: bool
    removed_volume: float


class WheelCriticalSpeed(TypedDict):
    amplitude_error: NotRequired[float]
    at_edge: bool
    clearance_consumption: NotRequired[float]
    index: int
    mean_force: NotRequired[float]
    on_branch: NotRequired[bool]
    peak_force: NotRequired[float]
    prominence: float
    resolved: bool
    settling: Verdict
    severity: float
    speed_error_rad_s: float
    speed_rad_s: float
    tip: TipResponse
    utilisation: NotRequired[float]
    validity: NotRequired[ValidityVerdict]
    validity_lacking: NotRequired[list[ValidityMeasure]]


class WheelInSi(TypedDict):
    centre_m: float
    mass_kg: float
    polar_inertia_kg_m2: float
    volume_m3: float


class Accuracy(TypedDict, closed=True):
    of: NotRequired[AccuracyOf]
    seconds: NotRequired[float]
    target: float


Along = TypedDict(
    "Along",
    {
        "from": float,
        "parameter": BranchParameter,
        "to": float,
    },
    closed=True,
)


class BackboneCurve(TypedDict):
    complete: bool
    component: Component
    contact_node: int
    end: str
    family: int
    nodal_diameter: int
    outside_coordinates: float
    passed: NotRequired[list[str]]
    points: list[BackbonePoint]


class Backbones(TypedDict):
    coordinates: int
    curves: list[BackboneCurve]
    model: str
    speed_rad_s: float
    units: Units
    version: str


class Bifurcation(TypedDict):
    error: float
    half_peak_to_peak: list[float]
    kind: BifurcationKind
    multiplier: NotRequired[FloquetMultiplier]
    speed_rad_s: float
    stable_modulus: NotRequired[float]
    value: float


class BranchMaximum(TypedDict):
    error: float
    half_peak_to_peak: float
    sensor: int
    speed_rad_s: float
    stability: Stability
    value: float


class BranchPoint(TypedDict):
    half_peak_to_peak: list[float]
    lobe_passages: int
    multipliers: list[FloquetMultiplier]
    newton_steps: int
    residual: float
    revolutions: float
    speed_rad_s: float
    stability: Stability
    value: float


class BranchTrack(Track):
    bifurcations: list[Bifurcation]
    ends: list[BranchEnd]
    maxima: list[BranchMaximum]
    points: list[BranchPoint]


class CampaignDesign(DesignOutcome):
    compared: NotRequired[DesignOutcome]
    index: int
    values: list[float]


CampaignThreshold = TypedDict(
    "CampaignThreshold",
    {
        "decided": int,
        "from": NotRequired[float],
        "mean": NotRequired[float],
        "message": str,
        "met_within": NotRequired[bool],
        "parameter": str,
        "probability": float,
        "shares": list[ThresholdShare],
        "standard_deviation": NotRequired[float],
        "to": NotRequired[float],
        "value": NotRequired[float],
    },
)


class CaseSpeed(TypedDict, closed=True):
    unit: SpeedUnit
    value: float


class Clearance(TypedDict, closed=True):
    given: NotRequired[ClearanceState]
    leading: NotRequired[float | None]
    trailing: NotRequired[float | None]
    values: NotRequired[list[float] | None]


class Control(TypedDict):
    differences: NotRequired[Errors]
    estimated_error: NotRequired[float]
    estimated_stress_error: NotRequired[float]
    index: int
    message: NotRequired[str]
    setting: Setting
    speed_rad_s: float
    steady: NotRequired[SteadyReport]


class CriticalSpeed(TypedDict):
    amplitude_error: NotRequired[float]
    at_edge: bool
    distance_rad_s: NotRequired[float]
    dominant_engine_order: NotRequired[float]
    dominant_nodal_diameter: NotRequired[int]
    frequency_error_rad_s: NotRequired[float]
    half_peak_to_peak: float
    index: int
    nearest_crossing: NotRequired[Crossing]
    on_branch: NotRequired[bool]
    prominence: float
    resolved: bool
    rms: float
    settling: Verdict
    speed_error_rad_s: float
    speed_rad_s: float
    utilisation: NotRequired[float]
    validity: NotRequired[ValidityVerdict]
    validity_lacking: NotRequired[list[ValidityMeasure]]


class Damping(TypedDict, closed=True):
    families_by: NotRequired[FamiliesBy]
    family_ratios: NotRequired[list[float]]
    modal_ratio: float


class Design(TypedDict, closed=True):
    kind: DesignKind
    points: NotRequired[list[list[float]] | None]
    seed: NotRequired[int | None]
    size: NotRequired[int | None]


Difference = TypedDict(
    "Difference",
    {
        "from": NotRequired[float],
        "mean": float,
        "pairs": int,
        "resolution": float,
        "standard_error": NotRequired[float],
        "to": NotRequired[float],
        "verdict": DifferenceVerdict,
    },
)


class DrivenCrossing(TypedDict):
    engine_order: int
    family: int
    frequency_hz: float
    nodal_diameter: int
    speed_rad_s: float
    wave: NotRequired[Wave]


class ErrorEstimate(TypedDict):
    controls: list[Control]
    largest: NotRequired[float]
    largest_of_stress: NotRequired[float]
    message: str
    points: list[PointError]
    target_met: NotRequired[bool]


class FlexibleCasing(TypedDict, closed=True):
    damping_ratio: NotRequired[float]
    modes: NotRequired[list[CasingMode] | None]
    ring: NotRequired[Ring | None]


class FoldedOrder(TypedDict):
    engine_order: int
    frequency_hz: float
    nodal_diameter: int
    of_lobes: bool
    wave: NotRequired[Wave]


class FollowedFamilies(TypedDict):
    assurance: list[list[list[float]]]
    ranks: list[list[list[int]]]
    veerings: list[Veering]


class FrequencyDifference(TypedDict):
    indefinite: list[int]
    largest: LargestDifference | None
    speed_rad_s: float


class Friction(TypedDict, closed=True):
    coefficient: float
    law: NotRequired[FrictionLaw]


class Grid(TypedDict, closed=True):
    kept_modes: NotRequired[list[AutoOr]]
    modes_per_speed: NotRequired[list[ModesPerSpeedItem]]
    schemes: NotRequired[list[SchemeChoice]]
    steps_per_revolution: NotRequired[list[StepsPerRevolutionItem]]


class HistoriesRequest(TypedDict, closed=True):
    quantities: NotRequired[list[RecordedQuantity]]
    revolutions: NotRequired[list[Revolution] | None]
    speeds: NotRequired[HistorySpeeds]


class HistoryLine(Setting):
    displacement: list[list[float]]
    reference: bool
    unknowns: int


class ImpellerParameters(TypedDict, closed=True):
    axial_length: NotRequired[float]
    backsweep_deg: NotRequired[float]
    bore_radius: NotRequired[float]
    contact_nodes: NotRequired[int]
    element_order: NotRequired[ElementOrder]
    gyroscopic: NotRequired[bool]
    inlet_hub_radius: NotRequired[float]
    inlet_tip_radius: NotRequired[float]
    material: NotRequired[Material]
    mesh: NotRequired[MeshDensities]
    outlet_blade_height: NotRequired[float]
    outlet_radius: NotRequired[float]
    rim_thickness: NotRequired[float]
    root_thickness: NotRequired[float]
    sectors: NotRequired[int]
    splitter: Splitter | None
    tip_thickness: NotRequired[float]
    top_speed_rad_s: NotRequired[float]
    units: NotRequired[Units]
    wrap_deg: NotRequired[float]


class ImpellerRequest(TypedDict, closed=True):
    axial_length: NotRequired[float]
    backsweep_deg: NotRequired[float]
    bore_radius: NotRequired[float]
    contact_nodes: NotRequired[int]
    element_order: NotRequired[ElementOrder]
    gyroscopic: NotRequired[bool]
    inlet_hub_radius: NotRequired[float]
    inlet_tip_radius: NotRequired[float]
    material: NotRequired[Material]
    mesh: NotRequired[MeshDensities]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    outlet_blade_height: NotRequired[float]
    outlet_radius: NotRequired[float]
    preset: NotRequired[Literal["small", "medium", "paper"]]
    rim_thickness: NotRequired[float]
    root_thickness: NotRequired[float]
    sectors: NotRequired[int]
    splitter: NotRequired[Splitter | None]
    tags: NotRequired[list[str]]
    tip_thickness: NotRequired[float]
    top_speed_rad_s: NotRequired[float]
    units: NotRequired[Units]
    wrap_deg: NotRequired[float]


class InSi(TypedDict):
    contact_radius_m: float
    mass_kg: float
    materials: NotRequired[list[MaterialInSi]]
    tip_speed_m_s: NotRequired[float]
    wheel: NotRequired[WheelInSi]


class Initial(TypedDict, closed=True):
    amplitude: float
    family: int
    nodal_diameter: int
    wave: NotRequired[InitialWave]


class Integration(TypedDict, closed=True):
    kept_modes: NotRequired[AutoOr]
    most_revolutions: NotRequired[int]
    ramp_revolutions: NotRequired[float]
    revolutions: NotRequired[AutoOr]
    scheme: NotRequired[SchemeChoice]
    settled_to: NotRequired[float]
    steady: NotRequired[SteadyChoice]
    steps_per_revolution: NotRequired[AutoOr]
    window_revolutions: NotRequired[int]


class InterferingMode(TypedDict):
    family: int
    frequency_hz: float
    met_in_range: NotRequired[list[int]]
    nearest: NotRequired[NearestOrder]
    nodal_diameter: int
    wave: NotRequired[Wave]


class JudgedValue(TypedDict):
    above_percent: float
    allowed: float
    error: NotRequired[float]
    limit: LimitKind
    standing: Standing
    value: float


class LevelValue(TypedDict):
    error: NotRequired[float]
    quantity: LimitKind
    standing: NotRequired[Standing]
    value: float


class LookRefusal(TypedDict):
    detail: str
    step: LookStep


class MeasuredSurvey(TypedDict):
    gap_count: int
    gaps: list[AngularGap]
    interpolation: str
    outlier_count: int
    outliers: list[Outlier]
    overshoot: NotRequired[Overshoot]


class MeshFacts(TypedDict):
    elements: int
    sets: list[Strengths]
    tip_thickness: NotRequired[float]


class MeshPatch(TypedDict):
    area: float
    at: list[int]
    axial: NotRequired[float]
    centre: list[float]
    nodes: int
    radius: NotRequired[float]
    role: NotRequired[MeshRole]
    triangles: int


class MeshSettings(TypedDict, closed=True):
    axis: NotRequired[dict[str, Any]]
    clamp_at: NotRequired[list[int]]
    clamp_set: NotRequired[str]
    contact_at: NotRequired[list[int]]
    contact_between: NotRequired[list[int] | None]
    contact_nodes: NotRequired[int]
    contact_set: NotRequired[str]
    gyroscopic: NotRequired[bool]
    mass: NotRequired[MassRule]
    materials: NotRequired[dict[str, Any]]
    mesh_file: NotRequired[str]
    name: NotRequired[str]
    sectors: NotRequired[int]
    shroud: NotRequired[list[list[float]] | None]
    temperatures: NotRequired[dict[str, float]]
    top_speed_rad_s: float
    units: NotRequired[Units]


class ModesBody(TypedDict):
    modes_per_speed: int
    nodal_diameters: list[ShapeFrequencies]
    speed_rad_s: float


class ModesChoice(TypedDict):
    accuracy: NotRequired[Accuracy]
    budget: NotRequired[Budget]
    error: float
    modes_per_speed: int
    reason: str
    tried: list[TriedModes]


OperatingRange = TypedDict(
    "OperatingRange",
    {
        "from": float,
        "name": str,
        "separation_percent": NotRequired[float | None],
        "to": float,
        "unit": SpeedUnit,
    },
    closed=True,
)


class Operation(TypedDict, closed=True):
    ranges: list[OperatingRange]


class Pilot(TypedDict):
    difference: NotRequired[float]
    error_of_modes: NotRequired[float]
    error_of_steps: NotRequired[float]
    modes_per_speed: int
    scheme: NotRequired[SchemeChoice]
    speed_rad_s: float
    steps_per_revolution: int
    time_s: float
    verdict: NotRequired[Verdict]


class PlannedPoint(TypedDict):
    computing_time_s: NotRequired[CostRange]
    index: int
    integrated_unknowns: int
    interference: NotRequired[float]
    memory_bytes: int
    message: NotRequired[str]
    scheme: NotRequired[SchemeReport]
    speed_rad_s: float
    steps: int
    steps_per_revolution: int


class PlannedResponse(TypedDict):
    computing_time_s: NotRequired[CostRange]
    integrated_unknowns: int
    message: NotRequired[str]
    scheme: NotRequired[SchemeReport]
    steps_per_revolution: int


class PlannedRunUp(TypedDict):
    computing_time_s: NotRequired[CostRange]
    duration_s: float
    frame_revolutions: int
    message: NotRequired[str]
    rate_rad_s2: NotRequired[float]
    revolutions: float
    scheme: NotRequired[SchemeReport]
    segments: int
    steps: NotRequired[int]


class PointStress(TypedDict):
    cycles: list[StressCycle]
    excluded_nodes: int
    excluded_radius: float
    followed_nodes: int
    lacking: NotRequired[str]
    largest: StressPeak
    largest_over_yield: NotRequired[float]
    largest_static: float
    leading: NotRequired[list[LeadingPlace]]


class PreliminaryStiffening(TypedDict):
    linear_ratio: float
    message: str
    quadratic_ratio: float
    verdict: StiffeningVerdict


class Problem(TypedDict):
    detail: str
    errors: NotRequired[list[ProblemItem]]
    instance: NotRequired[str]
    retry_after_s: NotRequired[int]
    status: int
    title: str
    type: str


class Record(TypedDict, closed=True):
    histories: NotRequired[HistoriesRequest | None]
    stress: NotRequired[StressRequest | None]


class Recorded(TypedDict, closed=True):
    quantities: NotRequired[list[RecordedQuantity]]
    revolutions: NotRequired[list[Revolution] | None]


class Refinement(TypedDict):
    added: int
    complete: bool
    rounds: int
    unresolved: NotRequired[list[Unresolved]]


class RunUpEnd(TypedDict):
    bending_residual: NotRequired[float]
    contact_share: float
    energy_residual: float
    euler_share: float
    largest: list[LargestOfRun]
    largest_angle_error_rad: float
    largest_energy: float
    largest_penetration: NotRequired[float]
    message: NotRequired[str]
    revolutions: float
    scheme: NotRequired[SchemeReport]
    segments: int
    status: PointStatus
    steps: int
    stiffening_work: float
    transfer_loss: float
    wall_time_s: float


class RunUpIntegration(TypedDict, closed=True):
    kept_modes: NotRequired[AutoOr]
    ramp_revolutions: NotRequired[float]
    scheme: NotRequired[SchemeChoice]
    steps_per_revolution: NotRequired[AutoOr]


RunUpSpeed = TypedDict(
    "RunUpSpeed",
    {
        "course": NotRequired[SpeedCourse | None],
        "from": NotRequired[float | None],
        "hold_s": NotRequired[float | None],
        "points": NotRequired[list[SpeedPoint] | None],
        "rates": NotRequired[list[float] | None],
        "to": NotRequired[float | None],
        "unit": SpeedUnit,
    },
    closed=True,
)


class SectorGeometry(TypedDict):
    contact: list[ContactPlace]
    disk: NotRequired[list[list[list[float]]]]
    name: str
    nodes: list[SectorNode]
    sectors: int
    silhouette: NotRequired[list[list[list[float]]]]
    units: Units


class SensorHistory(TypedDict):
    displacement: NotRequired[list[float]]
    sensor: Sensor
    tip: NotRequired[TipPlace]
    velocity: NotRequired[list[float]]


class SensorResponse(TypedDict):
    dominant_engine_order: NotRequired[float]
    dominant_nodal_diameter: NotRequired[int]
    half_peak_to_peak: float
    mean: float
    rms: float
    sensor: Sensor
    side_bands: NotRequired[list[SideBands]]


class SensorView(TypedDict):
    critical_speeds: list[CriticalSpeed]
    sensor: Sensor


class Settling(TypedDict):
    after_revolutions: NotRequired[int]
    largest_change: NotRequired[float]
    lobe_passages: NotRequired[int]
    ratio: NotRequired[int]
    side_band_spacing: NotRequired[float]
    verdict: Verdict


SpeedSet = TypedDict(
    "SpeedSet",
    {
        "count": NotRequired[int | None],
        "from": NotRequired[float | None],
        "to": NotRequired[float | None],
        "unit": SpeedUnit,
        "values": NotRequired[list[float] | None],
    },
    closed=True,
)


Speeds: TypeAlias = SpeedSet | list[SpeedSet]


class StiffeningReport(TypedDict):
    frequency_error: float
    linear_ratio: float
    message: str
    quadratic_ratio: float
    verdict: StiffeningVerdict


class StudyRun(Setting):
    cost: Cost
    energy_residual: NotRequired[float]
    errors: NotRequired[Errors]
    message: NotRequired[str]
    pareto: NotRequired[list[Quantity]]
    status: PointStatus
    steady: NotRequired[SteadyReport]
    time_s: float
    unknowns: int
    verdict: NotRequired[Verdict]


class ValidityCheck(TypedDict):
    beyond_above: NotRequired[float]
    doubtful_above: float
    scaled_from: NotRequired[int]
    value: float
    what: ValidityMeasure


class ValidityLack(TypedDict):
    reason: str
    what: ValidityMeasure


class WorstValue(TypedDict):
    index: int
    judged: JudgedValue
    speed_rad_s: float


class Casing(TypedDict, closed=True):
    clearance: Clearance
    lobes: NotRequired[Lobes | None]
    measured: NotRequired[Measured | None]
    single_lobes: NotRequired[list[SingleLobe]]
    tilt: NotRequired[Tilt | None]
    waves: NotRequired[list[Wave]]


class Choice(TypedDict):
    accuracy: NotRequired[Accuracy]
    budget: NotRequired[Budget]
    difference: NotRequired[float]
    error_of_modes: float
    error_of_steps: float
    estimated_at: int
    estimated_error: float
    expected_wall_time_s: float
    pilot_speeds_rad_s: list[float]
    pilots: list[Pilot]
    reason: str
    setting: Setting
    spent_s: NotRequired[float]
    spread: float


class Chosen1(Choice):
    kind: Literal["setting"]


class Chosen2(ModesChoice):
    kind: Literal["modes"]


Chosen: TypeAlias = Chosen1 | Chosen2


class Comparison(TypedDict):
    by_speed: list[Difference | None]
    limit: NotRequired[LimitsMet]
    message: str
    model: str
    sensitivities: NotRequired[Sensitivities]
    severity: NotRequired[Difference]
    threshold: NotRequired[CampaignThreshold]


class FoundShape(TypedDict):
    highest: NotRequired[float]
    measured: NotRequired[MeasuredSurvey]
    narrowest_rad: NotRequired[float]
    repeats: int


class GenerationPlan(TypedDict):
    dofs: int
    memory_bytes: int
    nodes: int
    settings: ImpellerParameters


class Histories(TypedDict):
    lines: list[HistoryLine]
    samples_per_revolution: int
    sensors: list[Sensor]
    speed_rad_s: float
    units: Units
    version: str


class Interference(TypedDict):
    between_rad_s: NotRequired[list[float] | None]
    engine_orders: list[FoldedOrder]
    families_by: FamiliesBy
    lobes: int
    model: str
    modes: list[InterferingMode]
    range_rad_s: NotRequired[list[float] | None]
    sectors: int
    speed_rad_s: float
    version: str


class JobBody(TypedDict):
    created_at: str
    error: NotRequired[Problem]
    finished_at: NotRequired[str]
    id: str
    kind: JobKind
    links: list[Link]
    model: NotRequired[str]
    name: NotRequired[str]
    notes: NotRequired[str]
    phase: NotRequired[str]
    progress: int
    speeds: NotRequired[SpeedCounts]
    started_at: NotRequired[str]
    status: JobStatus
    stored_bytes: int
    tags: list[str]
    updated_at: str
    verdict: NotRequired[VerdictWord]


class JobList(TypedDict):
    jobs: list[JobBody]
    next: NotRequired[str]


class JudgedSpeed(TypedDict):
    critical: bool
    engine_order: NotRequired[float]
    index: int
    limits: list[JudgedValue]
    nodal_diameter: NotRequired[int]
    ranges: list[RangePosition]
    resolved: NotRequired[bool]
    speed_error_rad_s: NotRequired[float]
    speed_rad_s: float
    tip: NotRequired[TipResponse]


class LevelSpeed(TypedDict):
    index: int
    speed_rad_s: float
    status: PointStatus
    values: list[LevelValue]


class MeasuredCasing(TypedDict):
    filled: list[FilledHeight]
    filled_count: int
    measured: Measured
    survey: MeasuredSurvey


class MeshLook(TypedDict):
    axis: NotRequired[list[list[float]] | None]
    chains: list[MeshChain]
    clamped: list[int]
    contact: list[int]
    contact_line: list[int]
    found: list[str]
    node_ids: list[int]
    patches: list[MeshPatch]
    positions: list[float]
    price: AssemblyPrice
    refusals: list[LookRefusal]
    sectors: NotRequired[int]
    triangles: list[int]


class ModalAnalysisRequest(TypedDict, closed=True):
    accuracy: NotRequired[Accuracy | None]
    backbones: NotRequired[BackbonesRequest | None]
    budget: NotRequired[Budget | None]
    coriolis: NotRequired[bool]
    families: NotRequired[int]
    families_by: NotRequired[FamiliesBy]
    fields: NotRequired[bool | None]
    lobes: NotRequired[int]
    max_engine_order: NotRequired[int]
    model: str
    modes_per_speed: NotRequired[AutoOr]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    speeds: Speeds
    superharmonics: NotRequired[list[Superharmonic]]
    tags: NotRequired[list[str]]


class ModelFacts(TypedDict):
    contact_nodes: int
    contact_radius: NotRequired[float]
    contact_spacing: NotRequired[float]
    digits: NotRequired[DigitNoise]
    found: NotRequired[list[str]]
    gyroscopic: NotRequired[bool]
    in_si: NotRequired[InSi]
    mesh: NotRequired[MeshFacts]
    name: str
    own_dofs: int
    sectors: int
    speeds_rad_s: list[float]
    stiffening: NotRequired[PreliminaryStiffening]
    units: Units
    warnings: NotRequired[list[str]]


class RangeVerdict(TypedDict):
    critical_inside: int
    critical_within_separation: int
    diverged: list[int]
    failed: list[int]
    from_rad_s: float
    limits: list[WorstValue]
    missing: list[int]
    name: NotRequired[str]
    separation_percent: float
    speeds: int
    to_rad_s: float
    verdict: VerdictWord


class ReductionReport(TypedDict):
    basis_tolerance: float
    counted_modes: int
    full_model: list[FrequencyDifference]
    largest_mode_residual: float
    modes: int
    modes_per_speed: int
    stiffening: StiffeningReport
    unknowns: list[int]
    version: str
    wall_time_s: float
    wheel_unknowns: int


class RunUp(TypedDict):
    end: NotRequired[RunUpEnd]
    frames: list[RunUpFrame]
    order_step: float
    rate_rad_s2: NotRequired[float]
    run: int


class Scene(TypedDict, closed=True):
    abradable: NotRequired[Abradable | None]
    casing: NotRequired[Casing | None]
    centrifugal_stiffening: NotRequired[bool]
    clearance_change: NotRequired[ClearanceChange | None]
    contact: NotRequired[Contact | None]
    coriolis: NotRequired[bool]
    damping: NotRequired[Damping | None]
    engine_order_excitation: NotRequired[list[EngineOrderExcitation]]
    flexible_casing: NotRequired[FlexibleCasing | None]
    friction: NotRequired[Friction | None]
    geometric_nonlinearity: NotRequired[GeometricNonlinearity | None]
    initial: NotRequired[Initial | None]
    mistuning: NotRequired[Mistuning | None]
    orbit: NotRequired[Orbit | None]
    probe: NotRequired[Probe | None]
    symmetry: NotRequired[Symmetry]


class SpeedStudy(TypedDict):
    message: str
    orders: list[StepOrder]
    reference: StudyRun
    runs: list[StudyRun]
    sensitivity: NotRequired[Sensitivity]
    speed_rad_s: float


class StudyRequest(TypedDict, closed=True):
    fields: NotRequired[bool | None]
    grid: NotRequired[Grid]
    history_revolutions: NotRequired[int]
    integration: NotRequired[StudyIntegration]
    max_engine_order: NotRequired[int]
    model: str
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    record: NotRequired[StudyRecord]
    scene: Scene
    sensors: NotRequired[list[Sensor]]
    speeds: Speeds
    tags: NotRequired[list[str]]


class SweepRequest(TypedDict, closed=True):
    accuracy: NotRequired[Accuracy | None]
    blade_thickness: NotRequired[float | None]
    budget: NotRequired[Budget | None]
    control_speeds: NotRequired[int | None]
    fields: NotRequired[bool | None]
    integration: NotRequired[Integration]
    limits: NotRequired[Limits | None]
    max_engine_order: NotRequired[int]
    model: str
    modes_per_speed: NotRequired[AutoOr]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    operation: NotRequired[Operation | None]
    peak_prominence: NotRequired[float]
    record: NotRequired[Record]
    refine: NotRequired[bool | None]
    reproducible: NotRequired[bool]
    scene: Scene
    sensors: NotRequired[list[Sensor]]
    speeds: Speeds
    sweep: NotRequired[SweepDirection]
    tags: NotRequired[list[str]]


class SweepVerdict(TypedDict):
    critical_speeds: list[JudgedSpeed]
    ranges: list[RangeVerdict]
    ranges_given: bool
    sentence: str
    settings: SweepRequest
    units: Units
    verdict: VerdictWord
    version: str
    worst: list[JudgedSpeed]
    would_decide: list[OpenQuestion]


class Validity(TypedDict):
    checks: list[ValidityCheck]
    lacking: NotRequired[list[ValidityLack]]
    verdict: ValidityVerdict


class WheelCriticalSpeeds(TypedDict):
    critical_speeds: list[WheelCriticalSpeed]
    missing: list[int]
    refinement: NotRequired[Refinement]
    sensors: list[SensorView]
    settings: SweepRequest
    units: Units
    version: str


class WorkPrecision(TypedDict):
    reductions: list[StudyReduction]
    settings: StudyRequest
    speeds: list[SpeedStudy]
    version: str


class BranchesRequest(TypedDict, closed=True):
    along: Along
    doubled: NotRequired[bool]
    integration: NotRequired[Integration]
    max_engine_order: NotRequired[int]
    model: str
    modes_per_speed: NotRequired[AutoOr]
    most_points: NotRequired[int]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    scene: Scene
    sensors: NotRequired[list[Sensor]]
    speed: CaseSpeed
    tags: NotRequired[list[str]]


class BranchesSettings(TypedDict, closed=True):
    along: Along
    doubled: bool
    most_points: int
    sweep: SweepRequest


class CampaignRequest(TypedDict, closed=True):
    compared_model: NotRequired[str | None]
    design: Design
    fields: NotRequired[bool | None]
    integration: NotRequired[Integration]
    limit: NotRequired[float | None]
    max_engine_order: NotRequired[int]
    model: str
    modes_per_speed: NotRequired[AutoOr]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    parameters: list[Parameter]
    scene: Scene
    sensors: NotRequired[list[Sensor]]
    severity: NotRequired[Severity]
    speeds: Speeds
    stress: NotRequired[StressRequest | None]
    tags: NotRequired[list[str]]
    threshold: NotRequired[Threshold | None]


class CampaignSettings(TypedDict, closed=True):
    added: NotRequired[int]
    compared: NotRequired[SweepRequest]
    design: Design
    designs: list[list[float]]
    limit: NotRequired[float]
    parameters: list[Parameter]
    severity: Severity
    sweep: SweepRequest
    threshold: NotRequired[Threshold]


class Campbell(TypedDict):
    absolute_frequencies_hz: list[AbsoluteFrequencies]
    crossings: list[Crossing]
    driven_crossings: list[DrivenCrossing]
    followed: NotRequired[FollowedFamilies]
    frequencies_hz: list[list[list[float]]]
    reduction: ReductionReport
    settings: ModalAnalysisRequest
    speeds_rad_s: list[float]
    version: str
    wall_time_s: float
    waves: NotRequired[WaveTables]


class CaseStudyRequest(TypedDict, closed=True):
    fields: NotRequired[bool | None]
    integration: NotRequired[Integration]
    max_engine_order: NotRequired[int]
    model: str
    modes_per_speed: NotRequired[AutoOr]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    record: NotRequired[Recorded]
    scene: Scene
    sensors: NotRequired[list[Sensor]]
    speed: CaseSpeed
    tags: NotRequired[list[str]]


class CaseStudySettings(TypedDict, closed=True):
    record: Recorded
    speeds: list[int]
    sweep: SweepRequest


class CriticalSpeeds(TypedDict):
    casing_coincidences: NotRequired[list[Coincidence]]
    critical_speeds: list[CriticalSpeed]
    driven_crossings: list[DrivenCrossing]
    linear_crossings: list[Crossing]
    missing: list[int]
    plan: NotRequired[Estimate]
    reduction: ReductionReport
    refinement: NotRequired[Refinement]
    sensor: Sensor
    settings: SweepRequest
    spent: NotRequired[Spent]
    units: Units
    version: str


class ForceMap(TypedDict):
    rows: list[ForceRow | None]
    settings: SweepRequest
    speeds_rad_s: list[float]
    units: Units
    version: str


class ModalAnalysisPlan(TypedDict):
    backbones_time_s: NotRequired[float]
    basis_bytes_at_most: NotRequired[int]
    choice: NotRequired[ModesChoice]
    computing_time_s: NotRequired[float]
    effects: list[PlannedEffect]
    nodal_diameters: int
    reduced_unknowns_at_most: int
    reduction: ReductionState
    settings: ModalAnalysisRequest
    speeds: int
    version: str
    warnings: NotRequired[list[str]]


class ModelBody(ModelFacts):
    created_at: str
    id: str
    notes: NotRequired[str]
    size_bytes: int
    tags: list[str]


class ModelDetail(ModelBody):
    reductions: list[ReductionReport]


class ModelList(TypedDict):
    models: list[ModelBody]
    next: NotRequired[str]


class Point(TypedDict):
    casing_amplitude: NotRequired[float]
    contact: NotRequired[ContactSummary]
    contact_impulse: NotRequired[float]
    contact_share: float
    energy: NotRequired[EnergyReport]
    energy_residual: NotRequired[float]
    index: int
    largest_energy: NotRequired[float]
    largest_penetration: NotRequired[float]
    march: NotRequired[MarchReport]
    message: NotRequired[str]
    responses: list[SensorResponse]
    running_clearance: NotRequired[list[float]]
    scheme: NotRequired[SchemeReport]
    settling: NotRequired[Settling]
    smallest_multiplier: NotRequired[float]
    smallest_stable_steps_per_revolution: int
    speed_rad_s: float
    status: PointStatus
    steady: NotRequired[SteadyReport]
    steps: int
    steps_per_revolution: int
    sticking_share: NotRequired[float]
    stiffening: NotRequired[StiffeningVerdict]
    stress: NotRequired[PointStress]
    symmetry_breaking: NotRequired[SymmetryBreaking]
    tip: NotRequired[TipResponse]
    validity: NotRequired[Validity]
    vectors: NotRequired[str]
    version: str
    wall_time_s: float
    wear: NotRequired[WearReport]


class RunUpRequest(TypedDict, closed=True):
    angle_tolerance_rad: NotRequired[float]
    euler_force: NotRequired[bool]
    frame_revolutions: NotRequired[AutoOr]
    integration: NotRequired[RunUpIntegration]
    limit: NotRequired[float | None]
    max_engine_order: NotRequired[int]
    model: str
    modes_per_speed: NotRequired[AutoOr]
    name: NotRequired[str | None]
    notes: NotRequired[str | None]
    scene: Scene
    sensors: NotRequired[list[Sensor]]
    speed: RunUpSpeed
    tags: NotRequired[list[str]]


class RunUpSettings(TypedDict, closed=True):
    angle_tolerance_rad: float
    euler_force: NotRequired[bool]
    frame_revolutions: AutoOr
    limit: NotRequired[float]
    speed: RunUpSpeed
    sweep: SweepRequest


class RunUps(TypedDict):
    complete: bool
    passing: NotRequired[PassingRate]
    runs: list[RunUp]
    sensors: list[Sensor]
    settings: RunUpSettings
    units: Units
    vectors: str
    version: str


class SensorMaps(TypedDict):
    amplitude: NotRequired[list[list[list[float] | None]]]
    engine_orders: list[float]
    errors: NotRequired[ErrorEstimate]
    nodal_diameter: NotRequired[int]
    plan: NotRequired[Estimate]
    points: list[Point]
    refinement: NotRequired[Refinement]
    sensors: list[Sensor]
    settings: SweepRequest
    speeds_rad_s: list[float]
    spent: Spent
    stiffening: NotRequired[StiffeningVerdict]
    units: Units
    version: str


class SpectraBody(TypedDict):
    contact: NotRequired[ContactForces]
    point: Point
    spectra: SpeedSpectra | None
    units: Units
    wear: NotRequired[WearMap]


class Spectrogram(TypedDict):
    amplitudes: list[list[float]]
    engine_orders: list[float]
    rate_rad_s2: NotRequired[float]
    run: int
    sensor: Sensor
    settings: RunUpSettings
    speeds_rad_s: list[list[float]]
    times_s: list[float]
    units: Units
    version: str


class SpeedHistories(TypedDict):
    contact: NotRequired[ContactHistory]
    energy: NotRequired[EnergyHistory]
    index: int
    point: Point
    revolutions: list[int]
    samples_per_revolution: int
    sensors: list[SensorHistory]
    settings: SweepRequest
    speed_rad_s: float
    units: Units
    version: str


class SpeedStress(TypedDict):
    index: int
    speed_rad_s: float
    stress: PointStress
    validity: NotRequired[Validity]


class StudyPlan(TypedDict):
    effects: list[PlannedEffect]
    reductions: list[int]
    settings: StudyRequest
    simulations: int
    speeds: int
    steps: int
    version: str
    warnings: NotRequired[list[str]]


class SweepLevel(TypedDict):
    speeds: list[LevelSpeed]
    verdict: SweepVerdict


class SweepPlan(TypedDict):
    added_speeds_at_most: NotRequired[int]
    basis_bytes_at_most: NotRequired[int]
    casing_shape: NotRequired[FoundShape]
    choice: NotRequired[Choice]
    contact_pairs: int
    effects: list[PlannedEffect]
    estimate: NotRequired[Estimate]
    machine: NotRequired[Machine]
    pilot_speeds_rad_s: NotRequired[list[float] | None]
    placed_sensors: NotRequired[list[PlacedSensor]]
    points: list[PlannedPoint]
    reduced_unknowns_at_most: int
    reduction: ReductionState
    settings: SweepRequest
    speeds: int
    stress_bytes: NotRequired[int]
    symmetry: FoundSymmetry
    validity_speeds_at_most: NotRequired[int]
    version: str
    warnings: NotRequired[list[str]]
    workers: int


class SweepStress(TypedDict):
    settings: SweepRequest
    speeds: list[SpeedStress]
    strengths: list[Strengths]
    units: Units
    version: str


class WearBody(TypedDict):
    point: Point
    units: Units
    wear: WearMap


class BranchesHead(TypedDict):
    kept_modes: NotRequired[int]
    parameter: BranchParameter
    scheme: SchemeChoice
    sensors: list[Sensor]
    settings: BranchesSettings
    steps_per_revolution: int
    units: Units
    vectors: str
    version: str


class BranchesPlan(TypedDict):
    basis_bytes_at_most: NotRequired[int]
    contact_pairs: int
    effects: list[PlannedEffect]
    estimate: NotRequired[Estimate]
    machine: NotRequired[Machine]
    point: NotRequired[PlannedResponse]
    points_at_least: int
    points_at_most: int
    reduced_unknowns_at_most: int
    reduction: ReductionState
    settings: BranchesSettings
    symmetry: FoundSymmetry
    version: str
    warnings: NotRequired[list[str]]


class Campaign(TypedDict):
    comparison: NotRequired[Comparison]
    designs: list[CampaignDesign]
    plan: NotRequired[Estimate]
    sensitivities: NotRequired[Sensitivities]
    settings: CampaignSettings
    speeds_rad_s: list[float]
    spent: Spent
    threshold: NotRequired[CampaignThreshold]
    units: Units
    version: str


class CampaignPlan(TypedDict):
    compared: NotRequired[SweepPlan]
    designs: int
    designs_at_most: int
    estimate: NotRequired[Estimate]
    reduction: ReductionState
    scene: SweepPlan
    settings: CampaignSettings
    simulations: int


HistoriesBody: TypeAlias = SpeedHistories | Histories


class InteractionMap(TypedDict):
    amplitude: NotRequired[list[list[float] | None]]
    engine_orders: list[float]
    errors: NotRequired[ErrorEstimate]
    nodal_diameter: NotRequired[int]
    plan: NotRequired[Estimate]
    points: list[Point]
    refinement: NotRequired[Refinement]
    sensor: Sensor
    settings: SweepRequest
    speeds_rad_s: list[float]
    spent: NotRequired[Spent]
    stiffening: NotRequired[StiffeningVerdict]
    units: Units
    version: str


MapBody: TypeAlias = InteractionMap | SensorMaps


PostedBody: TypeAlias = (
    SweepRequest
    | ModalAnalysisRequest
    | CaseStudyRequest
    | BranchesRequest
    | RunUpRequest
    | CampaignRequest
    | StudyRequest
    | ImpellerRequest
    | HistoriesRequest
)


ResolvedBody: TypeAlias = (
    SweepRequest
    | ModalAnalysisRequest
    | CaseStudySettings
    | BranchesSettings
    | RunUpSettings
    | CampaignSettings
    | StudyRequest
    | ImpellerParameters
)


class RunUpPlan(TypedDict):
    contact_pairs: int
    effects: list[PlannedEffect]
    estimate: NotRequired[Estimate]
    machine: NotRequired[Machine]
    reduced_unknowns_at_most: int
    reduction: ReductionState
    runs: list[PlannedRunUp]
    settings: RunUpSettings
    symmetry: FoundSymmetry
    version: str
    warnings: NotRequired[list[str]]


class Branches(BranchesHead):
    branches: list[BranchTrack]
    complete: bool


class JobDetail(JobBody):
    choice: NotRequired[Chosen]
    posted: NotRequired[PostedBody]
    posted_to: NotRequired[str]
    reduction: NotRequired[ReductionReport]
    request: ResolvedBody
