//! Invented measurements, for trying the library before you have measured beads of your own.

/// CSV of invented single beads over current and deposition speed; its first line says that they are invented. The wire
/// has 1.2 mm; the wire feed follows the current along a synergic line, wire and bead hold the same metal (parabola),
/// and λ is 2.5 to 3 at 100–150 A and 6–10 mm/s. The scatter of 1 % comes from a fixed sequence.
pub fn demonstration_csv() -> String {
    let mut csv = String::from(
        "# SYNTHETIC data for demonstration: invented by `beadwright bead example`, no bead was measured.\n\
         # Wire 1.2 mm, wire feed 0.0305 I + 0.000011 I² m/min; area 2/3 · width · height; scatter 1 %.\n\
         current_a,deposition_speed_mm_s,width_mm,height_mm\n",
    );
    let mut scatter = Scatter(0x5EED_BEAD);
    for current in [60.0, 80.0, 100.0, 125.0, 150.0, 200.0, 250.0] {
        for speed in [4.0, 6.0, 8.0, 10.0, 12.0] {
            let area = super::super::wire_area(1.2) * wire_feed(current) * 1000.0 / 60.0 / speed * scatter.next();
            let ratio = ratio(current, speed) * scatter.next();
            let width = (1.5 * area * ratio).sqrt();
            csv += &format!("{current},{speed},{width:.2},{:.2}\n", width / ratio);
        }
    }
    csv
}

/// Wire feed of the invented synergic line, m/min, over the current, A.
fn wire_feed(current: f64) -> f64 {
    0.0305 * current + 1.1e-5 * current * current
}

/// Invented λ over current, A, and deposition speed, mm/s: hot beads spread, fast ones less.
fn ratio(current: f64, speed: f64) -> f64 {
    let (hot, fast) = ((current - 125.0) / 25.0, (speed - 8.0) / 2.0);
    2.75 + 0.13 * hot - 0.006 * hot * hot - 0.06 * fast
}

/// Factors near 1 from a fixed sequence (splitmix64).
struct Scatter(u64);

impl Scatter {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let unit = ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        1.0 + 0.02 * (unit - 0.5)
    }
}
