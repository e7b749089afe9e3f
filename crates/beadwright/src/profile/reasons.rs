//! Why numbers have the limits they have, for error messages and forms.

/// The reason of a key's limits, as part of a sentence. What a controller or its maker sets has one reason a section.
pub(super) fn reason(key: &str) -> &'static str {
    let (section, name) = key.rsplit_once('.').unwrap_or(("", key));
    by_key(key).or_else(|| of_geometry(name)).unwrap_or_else(|| of_section(section))
}

fn by_key(key: &str) -> Option<&'static str> {
    Some(match key {
        "wire.diameter" => "wires of 0.6 to 4 mm are sold, and filament of up to 3 mm",
        "wire.density" => "plastics have about 1 g/cm³, tungsten 19",
        "process.wire_feed_speed" => "wire feeders end at about 30 m/min",
        "process.deposition_speed" => "without speed there is no bead; printers end at some hundred mm/s",
        "process.efficiency" => "no more metal can be laid than wire is fed",
        "process.arc_start_delay" | "process.arc_end_delay" => "standing longer with the arc on burns through",
        "process.gas_flow" => "above 25 L/min the flow becomes turbulent and draws air in",
        "process.gas_preflow" | "process.gas_postflow" => "a minute covers the coldest start; more only costs gas",
        "process.ctwd" => "beyond 30 mm the gas no longer covers the arc",
        "process.current" | "process.voltage" => "no power source of the trade gives more",
        "bead.width" => "from a printer's line to the widest weave",
        "bead.height" => "a bead that is higher than wide falls over",
        "layers.height" => "a layer is as high as its beads rise",
        "fill.stepover" => "nearer than 0.2 widths beads pile up; farther than two widths they do not touch",
        "fill.contour_gap" => "beads of different passes must overlap, and not lie on each other",
        "fill.perimeters" => "there is at least the outermost one",
        "fill.machining_allowance" => "more than this is another part",
        "fill.raster_angle" | "fill.raster_increment" => "a whole turn either way says everything",
        "fill.infill_density" => "from nothing but a hundredth to full",
        "fill.solid_layers" => "more layers than are planned at a time cannot be looked through",
        "fill.min_pass_length" => "shorter passes are all start and end: no steady arc",
        "loop.smoothing_length" => "the pool follows the speed over about its own length",
        "loop.width_step" => "a tenth of a width is seen by no eye; finer steps only make longer programs",
        "loop.relaxation" => "after some twenty rounds little changes",
        "loop.flip_length" => "shorter ones pile metal up, longer ones leave voids",
        "wall.chord_error" => "finer than this no controller runs, coarser than 1 mm is seen",
        "slice.close_gap" => "a wider gap is an opening, not a flaw of the file",
        "slice.simplify" => "more than a fifth of a bead would change the part",
        "travel.speed" => "robots end at 2 to 3 m/s",
        "travel.clearance" => "below 0 the torch would run into the part",
        "program.chord_tolerance" => "rounding takes 0.015 mm; more than half a bead would change the part",
        "program.speed_tolerance" => "the bead's width follows the speed: 30 % is the width of a process window",
        "start_stop.end_overlap" => "a longer overlap is a second bead",
        "start_stop.lead_in_power" => "a hot start has more power than the pass, up to what burns through",
        "start_stop.lead_out_power" | "start_stop.crater_power" => "the end of a pass has less power than the pass",
        "start_stop.crater_fill_time" => "a longer crater fill is a tower",
        "start_stop.wire_retract" => "farther back the wire leaves the contact tip",
        "start_stop.interpass_time" | "start_stop.min_layer_time" => "ten hours cool any part",
        "check.stacked_starts" => "one start over another is no tower yet",
        "motion.acceleration" => "a machine that hardly speeds up never gets there",
        "motion.corner_speed" => "a machine that stops at every corner has no corner speed to tell",
        "marlin.retract_length" => "more filament than this leaves the hot end",
        "krl.max_points" | "rapid.max_points" => "the pendant cannot show longer modules",
        "fanuc.max_points" | "inform.max_points" => "larger programs do not load into the controller",
        _ => return None,
    })
}

/// Lengths of strategies that are given in bead widths or stepovers, whatever their section.
fn of_geometry(name: &str) -> Option<&'static str> {
    Some(match name {
        "lead_in_length" | "lead_out_length" => "more than this is a pass of its own",
        "dwell_height" => "the torch must stay within reach of the robot",
        "min_width" => "narrower beads have no steady arc",
        "max_width" => "a bead wider than three times the nominal does not stand",
        "pocket_depth" => "pockets lie within reach of the bead beside them",
        "skeleton_gap" | "least_gap" | "contour_gap" => "beads must overlap, and not lie on each other",
        "end_overlap" | "end_gap" | "junction_gap" => "a bead's end reaches no farther than the bead is wide",
        "junction_tolerance" => "what lies two widths apart is not one junction",
        "corner_radius" => "a sharp corner stops the torch; a wide one leaves the part",
        "tolerance" => "slivers below it are rounding, pockets above it are real",
        "tip_reach" => "from not at all to all the way",
        "region_width" | "min_pocket_area" | "min_pocket_length" => {
            "sizes are told in beads, and parts have few across"
        }
        _ => return None,
    })
}

fn of_section(section: &str) -> &'static str {
    match section {
        "check" => "beyond this nothing would ever be found",
        "krl" | "rapid" | "rapid.seam" | "fanuc" | "inform" | "urscript" | "gcode" => {
            "the controller takes no other values, or no cell of the trade needs them"
        }
        "krl.arctech" => "the welding package takes no other values",
        "marlin" => "no printer of the trade goes beyond",
        "start_stop" => "beyond this it is no longer the start or end of a pass",
        _ => "beyond this the value has no meaning",
    }
}
