//! Kingery and Bulmash's constants against sources other than the one that they were typed from, and against properties:
//! the 256-point tables of OpenRadioss (`common_source/modules/loads/pblast_mod.F90`, arrays `rw3`,
//! `pso`, `pr`, `iso`, `irefl`, `ta`, `t0` and the same with `_surf`, from g, cm, microseconds and Mbar), and the form of
//! the polynomials in feet, pounds and psi (ConWep, ARL-TR-1310).

use super::kingery_bulmash::{Branch, Table, value};
use super::{air, swisdak, table};

const NONE: f64 = f64::NAN;

/// Z [m/kg^(1/3)], then P_so, P_r [kPa], i_s, i_r [kPa ms/kg^(1/3)], t_a, t_d [ms/kg^(1/3)]; no value where two branches
/// meet, since the table there is off by its own interpolation.
type Row = (f64, [f64; 6]);

/// The tables' own interpolation is off by 3e-5 at most at these points.
const TABLE: f64 = 4e-5;

const SPHERICAL: [Row; 18] = [
    (0.05409087467, [48465.14, 613183.7, 2528.898, 77205.33, 0.007840041, NONE]),
    (0.09137288479, [33300.47, 402053.4, 933.5092, 26055.59, 0.01402778, NONE]),
    (0.1503578137, [20946.33, 231443.3, 352.4158, 10188.62, 0.02628775, 0.2086025]),
    (0.1903653939, [16203.26, 169029.9, 241.8014, 6722.7, 0.03596141, 0.1921695]),
    (0.2474199233, [11738.86, 114541.1, 176.0772, 4322.488, 0.05175653, 0.1814303]),
    (0.4071395887, [5577.158, 47073.47, 136.6519, 1971.977, 0.1099413, 0.2326337]),
    (0.6357445796, [2448.639, 17145.01, 161.3778, 1031.677, 0.2330504, 0.5944658]),
    (0.6699648214, [2202.712, 15011.07, 168.1568, 958.899, 0.2557241, 0.7115023]),
    (0.9670241763, [1007.089, 5513.397, 178.9415, 584.1338, 0.4996129, 1.768178]),
    (1.102454476, [751.4402, 3766.105, 160.9292, 492.5854, 0.6383834, 1.82271]),
    (1.814133866, [242.2679, NONE, 100.6982, 264.9579, 1.624365, 1.734954]),
    (2.014688916, [191.5223, 632.3917, 91.51441, 233.7029, 1.970181, 1.858043]),
    (2.907992819, [86.9706, 233.1124, 66.11913, 152.4012, 3.78086, 2.635968]),
    (5.042795176, [30.84626, 68.90478, 40.30066, 82.54723, 9.109228, 3.343718]),
    (8.298125416, [14.32191, 30.3532, 25.24637, 48.36922, 18.01313, 3.962925]),
    (13.65490428, [7.368566, 15.26833, 15.64818, 28.62883, 32.88654, 4.605705]),
    (22.46970268, [3.795979, 7.670052, 9.574818, 16.96481, 58.19624, 5.31294]),
    (36.97481345, [1.902732, 3.858547, 5.772846, 9.975956, 101.0502, 6.035415]),
];

/// The incident impulse beyond Z = 0.955 stands in [`CONWEP_IMPULSE`].
const HEMISPHERICAL: [Row; 16] = [
    (0.07030248402, [53434.25, 696468.1, 2759.192, 79428.81, 0.01109939, NONE]),
    (0.1126924107, [34007.56, 405211.8, 1099.559, 30434.63, 0.01782594, NONE]),
    (0.1854399644, [19030.3, 208754.4, 419.0694, 12027.3, 0.03338897, 0.2524756]),
    (0.2972537445, [10322.82, 98449.89, 217.5265, 5365.27, 0.06488211, 0.2227387]),
    (0.4764873039, [5255.743, 43247.1, 166.645, 2549.592, 0.1327265, 0.2661205]),
    (0.784079319, [2220.035, 15134.68, 198.09, 1235.235, 0.3034258, 0.7643653]),
    (0.893888463, [1712.196, 10937.69, 222.1674, 1030.362, 0.3822074, 1.178652]),
    (1.256851588, [823.5346, 4280.512, NONE, 653.6817, 0.7113064, 2.204809]),
    (2.068200619, [262.8068, NONE, NONE, 349.2559, 1.804994, 2.064237]),
    (2.550762342, [164.0736, 517.0224, NONE, 271.4315, 2.652769, 2.355308]),
    (3.403308587, [89.14618, 238.7535, NONE, 193.8221, 4.411271, 3.113006]),
    (5.314233857, [38.86963, 89.34898, NONE, 117.384, 9.047333, 3.875256]),
    (8.744788851, [17.87565, 38.4704, NONE, 68.42233, 18.20056, 4.584351]),
    (14.01758915, [9.476391, 19.72138, NONE, 41.56647, 32.80396, 5.335016]),
    (23.06651544, [5.064084, 10.32088, NONE, 24.70217, 58.763, 6.172413]),
    (36.97481345, [2.639327, 5.339789, NONE, 15.05696, 98.94193, 6.984348]),
];

/// Z and i_s of the hemispherical burst by the third coefficient -0.0280816706301, 0.002 below the one used here.
const CONWEP_IMPULSE: [(f64, f64); 9] = [
    (1.256851588, 204.0726),
    (2.068200619, 129.3949),
    (2.550762342, 106.7547),
    (3.403308587, 82.86779),
    (5.314233857, 56.0965),
    (8.744788851, 35.26491),
    (14.01758915, 22.30325),
    (23.06651544, 13.6929),
    (36.97481345, 8.453304),
];
const CONWEP_DIFFERENCE: f64 = -0.002;

/// The six quantities of a row.
fn quantities(table: &Table) -> [&'static [Branch]; 6] {
    [
        table.incident_pressure,
        table.reflected_pressure,
        table.incident_impulse,
        table.reflected_impulse,
        table.arrival,
        table.duration,
    ]
}

/// The second source's values of one quantity: its place in a row, or the front's speed.
#[derive(Clone, Copy, PartialEq)]
enum Source {
    Column(&'static [Row], usize),
    /// the hemispherical incident impulse, whose two branches have a source each
    Impulse,
    /// U = c_0 sqrt(1 + 6 P_s / 7 P_0), which the polynomial follows within 6e-4 and crosses near Z = 31 and 40
    FrontSpeed,
}

/// The largest relative distance of a quantity from its second source, over what that source allows.
fn misses(branches: &[Branch], source: Source) -> f64 {
    let error = |z: f64, expected: f64| (value(branches, z).unwrap() / expected - 1.).abs() / TABLE;
    match source {
        Source::Column(rows, column) => {
            let rows = rows.iter().filter(|row| !row.1[column].is_nan());
            rows.map(|(z, row)| error(*z, row[column])).fold(0., f64::max)
        }
        Source::Impulse => {
            let near = misses(branches, Source::Column(&HEMISPHERICAL, 2));
            let conwep = changed(branches, 1, |b, c| {
                c[2] += CONWEP_DIFFERENCE;
                b
            });
            let error = |&(z, expected): &(f64, f64)| (value(&conwep, z).unwrap() / expected - 1.).abs() / TABLE;
            CONWEP_IMPULSE.iter().map(error).fold(near, f64::max)
        }
        Source::FrontSpeed => {
            let error = |(z, allowed): (f64, f64)| {
                let peak = value(table::HEMISPHERICAL.incident_pressure, z).unwrap();
                (value(branches, z).unwrap() / (1e-3 * air::front_speed(1e3 * peak)) - 1.).abs() / allowed
            };
            let errors = [(5., 1.4e-4), (10., 3.5e-4), (16., 2e-4), (31., 1.2e-5), (40., 7e-6)].map(error);
            errors.into_iter().fold(0., f64::max)
        }
    }
}

/// The branches with one of them changed: its k and until, and its coefficients.
fn changed(branches: &[Branch], number: usize, change: impl FnOnce(Branch, &mut Vec<f64>) -> Branch) -> Vec<Branch> {
    let copy = |b: &Branch| Branch { until: b.until, k: b.k, c: b.c };
    let mut all: Vec<Branch> = branches.iter().map(copy).collect();
    let mut c = all[number].c.to_vec();
    let branch = change(copy(&all[number]), &mut c);
    all[number] = Branch { c: c.leak(), ..branch };
    all
}

/// Every quantity with its name and its second source.
fn sources() -> Vec<(String, &'static [Branch], Source)> {
    let names =
        ["incident pressure", "reflected pressure", "incident impulse", "reflected impulse", "arrival", "duration"];
    let mut all = Vec::new();
    for (burst, table, rows) in [
        ("spherical", &table::SPHERICAL, &SPHERICAL as &'static [Row]),
        ("hemispherical", &table::HEMISPHERICAL, &HEMISPHERICAL as &'static [Row]),
    ] {
        for (column, (name, branches)) in names.iter().zip(quantities(table)).enumerate() {
            let source = match (burst, column) {
                ("hemispherical", 2) => Source::Impulse,
                _ => Source::Column(rows, column),
            };
            all.push((format!("{burst} {name}"), branches, source));
        }
    }
    all.push(("hemispherical speed".into(), table::HEMISPHERICAL.speed, Source::FrontSpeed));
    all
}

#[test]
fn kingery_and_bulmash_give_the_tables_of_another_program() {
    for (name, branches, source) in sources() {
        let miss = misses(branches, source);
        println!("{name}: {miss:.2} of what the second source allows");
        assert!(miss < 1., "{name}: {miss}");
    }
}

/// A typing error of 1 % of any constant's value changes a quantity by more than its second source allows; so does one of
/// 0.1 %, but for six of the 196, whose share of the value is below 5 % everywhere.
#[test]
fn the_second_source_sees_a_hundredth_of_every_constant() {
    let mut unseen = Vec::new();
    let mut count = 0;
    for (name, branches, source) in sources() {
        for number in 0..branches.len() {
            let constants = 2 + branches[number].c.len();
            count += constants;
            for which in 0..constants {
                let perturbed = |relative: f64| {
                    changed(branches, number, |b, c| match which {
                        0 | 1 => {
                            let mut k = b.k;
                            k[which] *= 1. + relative;
                            Branch { k, ..b }
                        }
                        i => {
                            c[i - 2] *= 1. + relative;
                            b
                        }
                    })
                };
                let seen = |relative: f64| misses(&perturbed(relative), source) > 1.;
                let what = format!(
                    "{name}, branch {number}, {}",
                    ["k0".into(), "k1".into()].get(which).cloned().unwrap_or(format!("c{}", which.wrapping_sub(2)))
                );
                assert!(seen(0.01) && seen(-0.01), "{what}");
                if !seen(1e-3) && !seen(-1e-3) {
                    unseen.push(what);
                }
            }
        }
    }
    println!("{count} constants; 0.1 % of these is not seen: {unseen:?}");
    assert!(count == 196 && unseen.len() <= 6, "{count}, {unseen:?}");
}

/// Branches, log10 of their quantity's unit in the table's, and (k_0, c_0) of each branch in feet and pounds.
type Form<'a> = (&'a [Branch], f64, &'a [[f64; 2]]);

/// The polynomials were printed in two systems of units: of the form in ft/lb^(1/3), psi and ms/lb^(1/3) only k_0 and
/// c_0 differ, by k_1 log10 of the unit of Z and by log10 of the quantity's. 3e-7 of k_1, 6e-7: their conversion's digits.
#[test]
fn feet_and_pounds_have_the_same_polynomials() {
    let (pound, foot, psi) = (0.453_592_37_f64, 0.3048, 6.894_757_293);
    let (z, time) = ((pound.cbrt() / foot).log10(), (1. / pound.cbrt()).log10());
    let (pressure, impulse) = (f64::log10(psi), f64::log10(psi) + time);
    let [s, h] = [&table::SPHERICAL, &table::HEMISPHERICAL];
    let forms: [Form; 13] = [
        (h.incident_pressure, pressure, &[[-0.756579301809, 1.9422502013]]),
        (s.incident_pressure, pressure, &[[-0.756579301809, 1.77284970457]]),
        (h.reflected_pressure, pressure, &[[-0.789312405513, 2.56431321138]]),
        (s.reflected_pressure, pressure, &[[-0.756579301809, 2.39106134946]]),
        (h.incident_impulse, impulse, &[[0.832468843425, 1.57159240621], [-2.91358616806, 0.719852655584]]),
        (s.incident_impulse, impulse, &[[1.04504877747, 1.43534136453], [-2.67912519532, 0.599008468099]]),
        (h.reflected_impulse, impulse, &[[-0.781951689212, 1.75291677799]]),
        (s.reflected_impulse, impulse, &[[-0.757659920369, 1.60579280091]]),
        (h.arrival, time, &[[-0.755684472698, -0.173607601251]]),
        (s.arrival, time, &[[-0.80501734056, -0.0423733936826]]),
        (
            h.duration,
            time,
            &[[-0.1790217052, -0.728671776005], [-5.85909812338, 0.20096507334], [-4.92699491141, 0.572462469964]],
        ),
        (
            s.duration,
            time,
            &[[0.209440059933, -0.801052722864], [-5.06778493835, 0.115874238335], [-4.39590184126, 0.50659210403]],
        ),
        (h.speed, f64::log10(foot), &[[-0.755684472698, 0.44977431]]),
    ];
    for (number, (branches, unit, form)) in forms.into_iter().enumerate() {
        assert_eq!(branches.len(), form.len());
        for (branch, [k_0, c_0]) in branches.iter().zip(form) {
            let [k, c] = [(k_0 + branch.k[1] * z - branch.k[0]) / branch.k[1], c_0 + unit - branch.c[0]];
            assert!(k.abs() < 3e-7 && c.abs() < 6e-7, "form {number}: {k:e}, {c:e}");
        }
    }
}

/// Of the two third coefficients in print the one used here fits what surrounds it: its branches meet within 0.6 %, for
/// 1.3 % with the other, and Swisdak's shorter fit follows it within 0.4 % (1.9 %). They are 1.8 % apart at most.
#[test]
fn the_incident_impulses_coefficient_is_the_one_that_fits() {
    let used = table::HEMISPHERICAL.incident_impulse;
    let other = changed(used, 1, |b, c| {
        c[2] += CONWEP_DIFFERENCE;
        b
    });
    let seam = 10f64.powf(used[0].until);
    let jump = |b: &[Branch]| (value(b, seam * 1.000_001).unwrap() / value(b, seam * 0.999_999).unwrap() - 1.).abs();
    let far = |b: &[Branch]| {
        let of = |z: f64| (value(b, z).unwrap() / swisdak::value(&swisdak::INCIDENT_IMPULSE, z) - 1.).abs();
        // its third piece starts 2.1 % off at 2.38 and is back on the curve from 2.8 on
        (0..200)
            .map(|i| 0.96 * 40f64.powf(f64::from(i) / 200.))
            .filter(|z| !(2.38..2.8).contains(z))
            .map(of)
            .fold(0., f64::max)
    };
    assert!(jump(used) < 0.006 && jump(&other) > 0.012, "{} {}", jump(used), jump(&other));
    assert!(far(used) < 0.0045 && far(&other) > 0.017, "{} {}", far(used), far(&other));
    let apart = CONWEP_IMPULSE.map(|(z, conwep)| (conwep / value(used, z).unwrap() - 1.).abs());
    assert!(apart.iter().all(|d| *d < 0.018) && apart[0] > 0.01, "{apart:?}");
}

/// A weak shock is reflected with twice its pressure. Beyond Z = 1, where air is an ideal gas, P_r / P_s is that of
/// Rankine and Hugoniot within 1.6 %, what the two fits leave, and within 0.7 % from Z = 8 on; 2 within 1.5 % at Z = 40.
#[test]
fn a_weak_shock_is_reflected_with_twice_its_pressure() {
    for table in [&table::SPHERICAL, &table::HEMISPHERICAL] {
        let ratio = |z| {
            let peak = value(table.incident_pressure, z).unwrap();
            (value(table.reflected_pressure, z).unwrap() / peak, air::reflected(1e3 * peak) / (1e3 * peak))
        };
        for z in (0..=200).map(|i| 40f64.powf(f64::from(i) / 200.)) {
            let (found, ideal) = ratio(z);
            let tolerance = if z < 8. { 0.016 } else { 0.007 };
            assert!((found / ideal - 1.).abs() < tolerance, "Z = {z}: {found}, not {ideal}");
        }
        let at = [1., 2., 4., 8., 16., 25.].map(|z| ratio(z).0);
        assert!(at.is_sorted_by(|a, b| a > b), "{at:?}");
        assert!((ratio(40.).0 / 2. - 1.).abs() < 0.015, "{}", ratio(40.).0);
    }
}

/// Pressure, reflected impulse and speed fall with the distance, arrival rises, at every 0.1 % of the way; the incident
/// impulse falls and the duration rises beyond their hump near Z = 1. The speed's polynomial turns up at Z = 39.7, by 1e-7.
#[test]
fn what_falls_with_the_distance_falls() {
    for table in [&table::SPHERICAL, &table::HEMISPHERICAL] {
        let [p_s, p_r, i_s, i_r, t_a, t_d] = quantities(table);
        let falls =
            [(p_s, 0.07), (p_r, 0.07), (i_r, 0.07), (table.speed, 0.07), (i_s, 1.1)].map(|(b, from)| (b, from, -1.));
        for (branches, from, sign) in falls.into_iter().chain([(t_a, 0.07, 1.), (t_d, 2.8, 1.)]) {
            let to: f64 = if std::ptr::eq(branches, table.speed) { 39.7 } else { 40. };
            let places = (0..=2000).map(|i: i32| from * f64::powf(to / from, f64::from(i) / 2000.));
            let values: Vec<f64> = places.filter_map(|z| Some(sign * value(branches, z)?)).collect();
            assert!(values.is_sorted_by(|a, b| a < b), "from {from}, sign {sign}");
        }
    }
}

/// The front runs at U = dR / dt_a: the slope of the arrival's polynomial and the speed's own agree within 3 %, up to Z = 35.
#[test]
fn the_front_arrives_as_fast_as_it_runs() {
    let table = &table::HEMISPHERICAL;
    for z in (0..=100).map(|i| 0.1 * 350f64.powf(f64::from(i) / 100.)) {
        let [before, after] = [1. - 1e-4, 1. + 1e-4].map(|f| value(table.arrival, f * z).unwrap());
        let (slope, speed) = (2e-4 * z / (after - before), value(table.speed, z).unwrap());
        assert!((slope / speed - 1.).abs() < 0.03, "Z = {z}: {slope}, {speed} km/s");
    }
}
