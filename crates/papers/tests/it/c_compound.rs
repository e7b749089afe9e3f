//! The figures of the page `c-compound` (Liu et al. 2022).

use beadwright::task::Task;
use beadwright_papers::c_compound;

/// Hooked ends take the voids without another pass; the overfill of 3 % is out of reach of plain ends too.
#[test]
fn hooked_ends_leave_a_fifth_of_the_voids_on_five_parts_at_twelve_angles() {
    let turned = c_compound::turned(&Task::new()).unwrap();
    let goals = c_compound::of_turned(&turned);
    let reached: Vec<bool> = goals.iter().map(|goal| goal.reached).collect();
    assert_eq!(reached, [false, false, true, false], "{goals:?}");
    for t in turned {
        let most = |voids: &[f64]| voids.iter().copied().fold(0.0, f64::max);
        let [plain, hooked] = t.overfill;
        println!(
            "{}: void {:.2} for {:.2} %, overfill {hooked:.2} for {plain:.2} %",
            t.part,
            most(&t.hooked),
            most(&t.plain)
        );
        assert!(t.hooked.iter().zip(&t.plain).all(|(hooked, plain)| hooked <= plain), "{}", t.part);
        assert!(most(&t.hooked) < 1.0 && most(&t.hooked) < 0.6 * most(&t.plain), "{}", t.part);
        assert!(plain > 3.0 && hooked < plain + 5.0, "{}: overfill {plain} and {hooked} %", t.part);
    }
}
