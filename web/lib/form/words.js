// Words for fields of requests: label, unit and, where those of the contract are not enough or too much, help. Fields stand in this order.

/**
 * A line for each field: name, label, unit, help, under the part of a request that it is in, or under none where it may be in any. In units, L, F and M are the model's
 * units of length, force and mass. Without help, that of the contract is shown; names that are words already have no line.
 */
const TABLE = `
# scene
casing|Casing||Off: the wheel spins freely.
# casing
clearance|Clearance||Distance from tip to casing; linear along the blade’s tip from its leading to its trailing edge.
# clearance
leading|At the leading edge|L|
trailing|At the trailing edge|L|
given|Given for the wheel||At speed, or cold: then the growth of the tips at speed is taken off.
values|At every contact node|L|In place of both ends: a list from the leading edge on.
# casing
lobes|Lobes||Equal bulges inward, evenly spaced around the casing. Off: the casing is round.
# lobes
count|Number of lobes||
amplitude|Height|L|
width_rad|Half-width|rad|From the crest to 37 % of the height.
phase_rad|Angle of the first|rad
#
along_chord|Share along the blade||One share of the height for every contact node, from the leading edge on; left out: the whole height at all.
# casing
single_lobes|Single lobes and hollows
# single_lobes
angle_rad|Angle|rad
amplitude|Height|L|Negative: a hollow.
width_rad|Half-width|rad
# casing
waves|Waves (Fourier series)
# waves
order|Waves around
amplitude|Height|L|Of a crest.
phase_rad|Angle of a crest|rad
# casing
measured|Measured shape
# measured
angles_rad|Angles|rad
chord|Places along the blade
heights|Heights|L
# casing
tilt|Tilted axis
# tilt
angle_rad|Angle|rad
towards_rad|Towards|rad
about_z|About z =|L
# speeds
from|From||
to|To||
unit|Unit||
count|Number of speeds||Evenly spaced, both ends included.
values|Single speeds||A list in place of a range.
# speed
value|Speed||
unit|Unit||
from|From||
to|To||
rates|Rates|in that unit per second|One run for each, without a sign.
hold_s|Held before|s|At the first speed, until what begins with the run has died away.
# points
time_s|Time|s
speed|Speed||
# speed
course|Course through points
#
along|Followed along
# along
parameter|What changes||
from|From||Speeds in the unit of the speed; others as multiples of the scene’s.
to|To||
#
lobes|Lobes of the casing||Whose harmonics may drive the wheel.
superharmonics|Harmonics of the lobes||Of the linear criterion, a list.
families|Families of modes||Frequencies per nodal diameter.
families_by|Families told by||Shape: a family keeps its shape over speed. Rank: by frequency at each speed.
backbones|Backbone curves||Frequency of free vibration over its amplitude, at the highest speed. Needs a mesh.
# backbones
coordinates|Coordinates of a blade||
nodal_diameters|Nodal diameters||Left out: all.
largest_amplitude|Largest amplitude|L|Left out: twice the thickness of the blade at its tip.
#
operation|Operating ranges||Speeds at which the machine runs: the verdict is about them. Off: all speeds are judged.
# operation
ranges|Range||
# ranges
name|Name||
from|From||
to|To||
unit|Unit||
separation_percent|Separation asked for|%|How far critical speeds are to stay off either end.
#
limits|Limits||What must not be passed; any one or several. Off: the verdict stays undecided.
# limits
clearance_consumption|Clearance consumption|of the clearance|0.9: the outward motion of a tip may take 90 % of its clearance.
tip_motion|Tip motion|L|To either side of its middle.
utilisation|Utilisation|of the strength|Of the material, by Goodman’s rule; 1: nothing is left. Needs its strengths; stress is recorded then.
node_force|Contact force on a node|F|
#
blade_thickness|Blade thickness at the tip|L|By which linear theory is checked where the model has no elements that show it.
limit|Limit of displacement|L|Not to be passed.
parameters|Parameters||What varies from design to design.
# parameters
name|Name||
at|Where||Pointers to the numbers of the scene that it changes, such as /scene/casing/lobes/amplitude.
change|The value||How it changes these numbers.
from|From|as the numbers
to|To|as the numbers
levels|Values in a grid
mean|Mean|as the numbers
standard_deviation|Standard deviation|as the numbers
mode|Most probable|as the numbers
values|Values|as the numbers
#
design|Designs
# design
kind|How they are chosen
size|How many
points|Given designs
# threshold
within|Known to within|as the parameter
batch|Designs at a time
most_designs|Most designs
#
compared_model|Compared with the model||Id of another model with which every design is simulated, too.
grid|Settings to compare||Every combination is run.
# grid
steps_per_revolution|Steps per revolution
modes_per_speed|Modes per speed
kept_modes|Kept modes
#
history_revolutions|Compared over|revolutions|From the start, before chaos parts histories.
# damping
modal_ratio|Damping ratio ζ of all modes|of critical|0.005 is usual for a wheel of one piece in a gas; bladed joints have more.
family_ratios|Ratios ζ of the first families|of critical|In place of it, a list for the first families of modes.
# scene
contact|Contact of tips and casing||Off: tips pass through the casing.
# friction
coefficient|Coefficient μ
# scene
abradable|Abradable coating||Off: blades touch the metal.
# abradable
thickness|Thickness|L
modulus|Young’s modulus|F/L²
yield_stress|Yield stress|F/L²
hardening|Plastic modulus|F/L²
rods_around|Rods around
# scene
clearance_change|Clearance that changes||Closes or opens during a run.
# course
revolutions|After|revolutions
change|Change|L
# scene
centrifugal_stiffening|Stiffening by rotation||Stiffness at speed by the matrices of the model; off: that at rest.
coriolis|Coriolis forces||Forward and backward waves get frequencies of their own. Needs the gyroscopic matrix.
#
coriolis|Coriolis forces||Forward and backward waves get frequencies of their own. Needs the gyroscopic matrix.
# scene
mistuning|Mistuning||Sectors that differ in stiffness.
# scene
geometric_nonlinearity|Blades that bend far||Off: linear theory. Needs a mesh; not with friction.
# geometric_nonlinearity
include|Included||Full: tips draw back as blades bend, and blades stiffen. Kinematics: tips draw back, stiffness stays linear; takes less time.
coordinates|Coordinates of a blade||Shapes in which a blade bends far: compare runs with 6, 7 and 8.
# mistuning
spread|Standard deviation|of the stiffness
deviations|Deviations|of the stiffness
# scene
initial|Initial motion||Off: the wheel begins at rest.
# initial
nodal_diameter|Nodal diameter
amplitude|Amplitude|L
# scene
flexible_casing|Flexible casing||Off: the casing is rigid.
# ring
radius|Radius|L
area|Area of the section|L²
second_moment|Second moment of area|L⁴
modulus|Young’s modulus|F/L²
density|Density|M/L³
n_max|Highest nodal diameter
# modes
nodal_diameter|Nodal diameter
frequency_hz|Frequency|Hz
modal_mass|Modal mass|M
# flexible_casing
damping_ratio|Damping ratio|of critical
# scene
orbit|Eccentric casing or whirling shaft||Off: the wheel turns about the casing’s axis.
# orbit
radius|Radius|L
whirl_ratio|Whirl speed|of the rotation
phase_rad|Angle at the start|rad
# scene
engine_order_excitation|Forces at engine orders
# engine_order_excitation
order|Engine order
amplitude|Amplitude|F|
component|Direction
contact_nodes|Contact nodes
phase_rad|Phase|rad
#
euler_force|Euler force
# scene
symmetry|Symmetry that is used
probe|Asymmetry of the probe
# probe
amplitude|Size|of the clearance
#
sensors|Sensors||Where the response is reported in detail. Left out: along the contact normal, at both ends of the tip of sector 0. The verdict looks at all tips.
# sensors
contact_node|Contact node||From the leading edge, from 0.
sector|Sector||From 0.
component|Direction||
direction|Own direction|radial, tangential, axial
node|Node of the package
nearest|Nearest to the point|L
gauge|Strain gauge
# gauge
nodes|Two nodes
at|Middle|L
direction|Direction|x, y, z
length|Length|L
#
record|Recorded as well||
# record
stress|Stress||At every speed, with the most utilised places. Needs a model with elements.
#
stress|Stress||At every speed. Needs a model with elements.
# stress
excluded_radius|Left out around contact nodes|L
strengths|Strengths of the material||In place of those of the model, which may have none; utilisation needs ultimate and fatigue strength.
# record
histories|Histories||Motion and forces over time, at some speeds.
#
fields|For fields and stress of the whole wheel
scene|Effects
# accuracy
target|Error to stay below|of the response
of|Error of
seconds|Longest choice|s
#
budget|Time budget||The program chooses settings that keep to it.
# budget
seconds|Time|s
#
modes_per_speed|Modes per speed and nodal diameter||How exact the reduced wheel is; auto: 20, or what accuracy or budget choose.
integration|Time integration||Scheme, steps and length of a run. Off: chosen by the program.
# integration
steps_per_revolution|Steps per revolution
most_revolutions|Most revolutions
window_revolutions|Window of spectra|revolutions
ramp_revolutions|Ramp|revolutions
settled_to|Counts as settled|of the motion
steady|Steady response
kept_modes|Kept modes
#
refine|More speeds around peaks||Until every peak is resolved.
control_speeds|Control runs|speeds|Simulated again at a finer setting: error bars of all speeds come from them.
sweep|Each speed starts from
max_engine_order|Highest engine order
peak_prominence|Least prominence of a peak|of the largest|Smaller peaks are no critical speeds.
reproducible|Same bits on all machines||All speeds on processors with the same vector instructions.
doubled|Follow doubled periods
most_points|Most points of a branch
frame_revolutions|Revolutions of a frame|revolutions
angle_tolerance_rad|Tolerance of the angle|rad
name|Name||
tags|Tags||Words to group by, with commas between them.
notes|Notes||
sectors|Number of sectors||Main blades, at least 3.
outlet_radius|Outlet radius|L|R2: of the trailing edge and the rim.
inlet_tip_radius|Inlet radius at the tip|L|R1t: of the tip at the leading edge.
inlet_hub_radius|Inlet radius at the hub|L|R1h: of the hub at the leading edge.
bore_radius|Radius of the bore|L|Rb: clamped to the shaft.
axial_length|Axial length|L|Z: from the leading edge to the hub’s surface at the outlet.
outlet_blade_height|Blade height at the outlet|L|b2: along the axis.
rim_thickness|Thickness of the rim|L|t: behind the blades; the back face is plane.
root_thickness|Blade thickness at the hub|L|Normal to the blade.
tip_thickness|Blade thickness at the tip|L|Normal to the blade, at most that at the hub.
wrap_deg|Wrap of the blade|°|From the leading to the trailing edge about the axis.
backsweep_deg|Backsweep|°|From the radial direction at the trailing edge, backwards.
splitter|Splitter blades||Shorter blades between the main ones.
# splitter
leading_edge|Leading edge at|of the meridional length
#
contact_nodes|Contact nodes along the tip||Evenly spaced, at least 2.
top_speed_rad_s|Top speed|rad/s|Highest speed of the stiffness matrices.
gyroscopic|Gyroscopic matrix||For Coriolis forces.
material|Material||Off: the titanium of the presets, without strengths.
# material
youngs_modulus|Young’s modulus E|F/L²|
poissons_ratio|Poisson’s ratio ν||
density|Density ρ|M/L³|
#
yield_strength|Yield strength|F/L²|
ultimate_strength|Ultimate strength|F/L²|Left out: no utilisation.
fatigue_strength|Fatigue strength||Amplitude of a fully reversed stress. Off: no utilisation.
# fatigue_strength
amplitude|Amplitude|F/L²|
source|Source||Standard or test, number of cycles, surface, temperature.
#
element_order|Order of the elements
mesh|Mesh||Numbers of elements.
# mesh
between_contact_nodes|Between two contact nodes
blade_height|Over the height of a blade
blade_thickness|Through the thickness of a blade
disk|Through the disk
half_passage|Across half a passage
#
units|Units||Consistent: force = mass · length / time².
# units
length|Length||
force|Force||
time|Time||
mass|Mass||
`;

/** @type {Map<string, [string, string?, string?]>} */
const WORDS = new Map(TABLE.trim().split(/^# ?/m).flatMap((group) => {
  const [part, ...lines] = group.trimEnd().split('\n');
  return lines.map((line) => line.split('|')).map(([name, ...words]) => [`${part}/${name}`, words]);
}));

const ORDER = new Map([...WORDS.keys()].map((key, k) => [key, k]));

/** Key of the words of a field, if it has some. */
function keyOf(pointer) {
  const [parent, name] = ['', ...pointer.split('/').slice(1).filter((word) => word !== '-' && !/^\d+$/.test(word))].slice(-2);
  return [`${parent}/${name}`, `/${name}`].find((key) => WORDS.has(key));
}

/** Label, unit and help of a field by its pointer; nothing where there are none. */
export function wordsOf(pointer) {
  const key = keyOf(pointer);
  return key ? WORDS.get(key) : null;
}

/** Names of an object's fields in the order of the words, others last. */
export function ordered(names, pointer) {
  const place = (name) => ORDER.get(keyOf(`${pointer}/${name}`)) ?? ORDER.size;
  return names.toSorted((a, b) => place(a) - place(b));
}

/** A unit that others are divided by or raised, in brackets where it is more than a word. */
function part(unit) {
  return /[/·*^ ]/.test(unit) ? `(${unit})` : unit;
}

/** A unit of the words in the units of a model: `F/L²` becomes `N/mm²`. */
export function unitIn(code, units) {
  if (!/[LFM]/.test(code)) return code;
  if (!units) return '';
  const names = { L: units.length, F: units.force, M: units.mass };
  return code.replace(/[LFM]/g, (letter) => (code === letter ? names[letter] : part(names[letter])));
}
