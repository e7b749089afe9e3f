//! What numbers usually are in arc welding. Others are possible, but mostly slips of the keyboard or of the unit.

use super::Profile;

/// Keys with their least and greatest usual value, in the units of their limits.
const USUAL: [(&str, f64, f64); 11] = [
    ("process.wire_feed_speed", 0.3, 25.0),
    ("process.deposition_speed", 1.0, 60.0),
    ("process.current", 15.0, 600.0),
    ("process.voltage", 8.0, 50.0),
    ("process.gas_flow", 2.0, 60.0),
    ("process.ctwd", 2.0, 50.0),
    ("wire.diameter", 0.6, 4.0),
    ("bead.width", 1.0, 30.0),
    ("bead.height", 0.3, 12.0),
    ("layers.height", 0.3, 12.0),
    ("travel.speed", 5.0, 1000.0),
];

impl Profile {
    /// The least and the greatest value that a key usually has; `None` for keys that may be anything, and for printers.
    ///
    /// ```
    /// use beadwright::Profile;
    ///
    /// let profile = Profile::built_in("cmt-al2319-kuka")?;
    /// assert!(profile.usual("process.wire_feed_speed").is_some_and(|(_, most)| most < 99.0));
    /// assert_eq!(profile.usual("fill.raster_angle"), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn usual(&self, key: &str) -> Option<(f64, f64)> {
        let of_key = USUAL.iter().find(|(known, ..)| *known == key);
        of_key.filter(|_| !self.prints()).map(|(_, least, most)| (*least, *most))
    }
}
