//! Findings: sentences about the figures in each command's JSON.

use serde_json::Value;

use crate::{output::table::figure, product::DEFAULT, stats::worse};

/// Budget of cloth in a frame, ms.
const BUDGET: f64 = 1.0;
/// Relative difference of a length or a frequency between levels from which on it is visible.
const LEVELS_AGREE: f64 = 0.05;
/// Largest invisible pop, pixels.
const POP: f64 = 1.0;
/// Fraction of the kinetic energy that a change of level may add.
const ENERGY: f64 = 0.01;
/// Factor by which the largest strain may differ from the reference's, up or down.
const STRAIN: f64 = 1.5;
/// Fraction by which the schedule may exceed plain calls.
const SCHEDULE: f64 = 0.1;
/// Time of flags by need, over that of all with the greatest number of substeps that any needs, and over that of all with the
/// mean number.
const SHARED: [f64; 2] = [1.0, 1.15];
/// Number of failing cases that are named.
const NAMED: usize = 3;

/// One sentence, good or bad news.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether it is good.
    pub good: bool,
    /// The sentence.
    pub text: String,
}

impl Finding {
    /// A finding.
    #[must_use]
    pub fn new(good: bool, text: String) -> Self {
        Self { good, text }
    }
}

/// Findings about a command's figures.
#[must_use]
pub fn of(command: &str, json: &Value) -> Vec<Finding> {
    match command {
        "oracles" => cases(json, "closed forms are met", oracle_gap),
        "stability" => cases(json, "hard cases hold", stability_gap),
        "pareto" => pareto(json),
        "budget" => budget(json),
        "lod" => lod(json),
        "schedule" => schedule(json),
        "sharing" => sharing(json),
        "peers" => peers(json),
        _ => Vec::new(),
    }
}

fn rows<'a>(json: &'a Value, key: &str) -> &'a [Value] {
    json[key].as_array().map_or(&[], Vec::as_slice)
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or(f64::NAN)
}

fn text<'a>(row: &'a Value, key: &str) -> &'a str {
    row[key].as_str().unwrap_or("?")
}

fn oracle_gap(case: &Value) -> f64 {
    number(case, "relative_error") / number(case, "tolerance")
}

fn stability_gap(case: &Value) -> f64 {
    number(case, "worst") / number(case, "limit")
}

/// Number of cases that pass, and the worst failing cases with the factors by which they miss their limits.
fn cases(json: &Value, what: &str, gap: fn(&Value) -> f64) -> Vec<Finding> {
    let built = rows(json, "cases").iter().filter(|case| text(case, "status") != "not_built");
    let (passed, mut failed): (Vec<&Value>, Vec<&Value>) =
        built.partition(|case| case["pass"].as_bool() == Some(true));
    let total = passed.len() + failed.len();
    let mut findings = Vec::new();
    if !passed.is_empty() {
        findings.push(Finding::new(true, format!("{} of {total} {what}", passed.len())));
    }
    // NaN counts as the worst.
    failed.sort_by(|a, b| gap(b).abs().total_cmp(&gap(a).abs()));
    if !failed.is_empty() {
        let name = |case: &&Value| match gap(case) {
            gap if gap.is_finite() => format!("{} (by {} ×)", text(case, "name"), figure(gap)),
            _ => text(case, "name").to_owned(),
        };
        let named: Vec<String> = failed.iter().take(NAMED).map(name).collect();
        let sentence = format!("{} of {total} fail, most: {}", failed.len(), named.join("; "));
        findings.push(Finding::new(false, sentence));
    }
    findings
}

/// Speed of this project relative to every other method with no greater error, by scene, and the ratio of its
/// largest strain to the reference's.
fn pareto(json: &Value) -> Vec<Finding> {
    let mut scenes: Vec<(&str, u64)> = Vec::new();
    for row in rows(json, "rows") {
        let scene = (text(row, "scene"), row["n"].as_u64().unwrap_or(0));
        if !scenes.contains(&scene) {
            scenes.push(scene);
        }
    }
    let of_scene = |(scene, n)| [fastest(json, scene, n), largest_strain(json, scene, n)];
    scenes.into_iter().flat_map(of_scene).flatten().collect()
}

fn fastest(json: &Value, scene: &str, n: u64) -> Option<Finding> {
    let (key, unit) = match scene {
        "swing" => ("rms_error_m", " m from the reference"),
        _ => ("strain_error", " off the mean strain"),
    };
    let error = |row: &Value| number(row, key);
    let time = |row: &Value| number(row, "us_per_cloth_tick");
    let (ours, others): (Vec<&Value>, Vec<&Value>) = on(json, scene, n)
        .filter(|row| row["stable"].as_bool() == Some(true) && error(row).is_finite())
        .partition(|row| text(row, "method").starts_with("bunting"));
    // The error does not depend on the number of lanes: of the most exact settings the fastest is chosen.
    let order = |a: &Value, b: &Value| {
        error(a).total_cmp(&error(b)).then_with(|| time(a).total_cmp(&time(b)))
    };
    let best = ours.into_iter().min_by(|a, b| order(a, b))?;
    let rivals = others.into_iter().filter(|row| error(row) <= error(best));
    let rival = rivals.min_by(|a, b| time(a).total_cmp(&time(b)));
    let found = format!(
        "{scene} {n}²: {}{unit} in {} µs a cloth, of {} at once",
        figure(error(best)),
        figure(time(best)),
        best["lanes"]
    );
    Some(match rival {
        None => Finding::new(true, format!("{found}; none of the others run errs as little")),
        Some(rival) => {
            let ratio = time(rival) / time(best);
            let (method, ratio_text) = (text(rival, "method"), figure(ratio));
            Finding::new(
                ratio > 1.0,
                format!("{found}; the next as exact, {method}, takes {ratio_text} × that"),
            )
        }
    })
}

/// Largest strain of a cloth that hangs or flies, with default settings.
fn largest_strain(json: &Value, scene: &str, n: u64) -> Option<Finding> {
    let reference = rows(json, "references")
        .iter()
        .find(|it| text(it, "scene") == scene && it["n"].as_u64() == Some(n))?;
    let default = on(json, scene, n).find(|row| {
        text(row, "method") == "bunting yarns"
            && row["substeps"] == DEFAULT.substeps
            && row["passes"] == DEFAULT.passes
    })?;
    let [measured, expected] = [default, reference].map(|it| number(it, "max_stretch"));
    let sentence = format!(
        "{scene} {n}²: the largest strain is {:.2} % by default, {:.2} % in the reference",
        100.0 * measured,
        100.0 * expected
    );
    let is_alike = (measured / expected).ln().abs() <= STRAIN.ln();
    (scene != "swing").then(|| Finding::new(is_alike, sentence))
}

/// Rows of a comparison on one scene at one size.
fn on<'a>(json: &'a Value, scene: &'a str, n: u64) -> impl Iterator<Item = &'a Value> {
    let rows = rows(json, "rows").iter();
    rows.filter(move |row| text(row, "scene") == scene && row["n"].as_u64() == Some(n))
}

fn budget(json: &Value) -> Vec<Finding> {
    let thousand = &json["thousand"];
    let [median, worst] = ["ms_median", "ms_worst_second"].map(|key| number(thousand, key));
    let mut findings = vec![Finding::new(
        worst <= BUDGET,
        format!(
            "1000 flags around a moving camera take {} ms a tick on one core, {} ms in the worst \
             second; the budget is {BUDGET} ms",
            figure(median),
            figure(worst),
        ),
    )];
    let within = rows(json, "many_flags")
        .iter()
        .filter(|sheet| sheet["n"] == 33 && sheet["cores"] == 1)
        .map(|sheet| (BUDGET / number(sheet, "ms_per_tick") * number(sheet, "cloths"), sheet))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((flags, sheet)) = within {
        let scheme = text(sheet, "scheme");
        let sentence = format!("{BUDGET} ms of one core holds {flags:.0} flags of 33² ({scheme})");
        findings.push(Finding::new(true, sentence));
    }
    findings
}

fn lod(json: &Value) -> Vec<Finding> {
    let levels = rows(json, "levels");
    let mut findings = Vec::new();
    for (key, what) in [
        ("droop_m", "droop"),
        ("swing_period_s", "swing period"),
        ("flutter_hz", "flutter frequency"),
    ] {
        let off = levels.iter().filter_map(|level| {
            let finest = levels.iter().find(|other| other["scheme"] == level["scheme"])?;
            Some((number(level, key) / number(finest, key) - 1.0).abs())
        });
        let worst = off.fold(0.0, worse);
        let sentence = format!("the levels' {what} differs by up to {:.1} %", 100.0 * worst);
        findings.push(Finding::new(worst <= LEVELS_AGREE, sentence));
    }
    let worst = |list: &str, key: &str| {
        rows(json, list).iter().map(|change| number(change, key)).fold(0.0, worse)
    };
    let (pop, energy) = (worst("pops", "worst_px"), worst("switches", "energy_worst"));
    let sentence = format!("a change of level pops by {} pixels at most", figure(pop));
    findings.push(Finding::new(pop <= POP, sentence));
    let sentence = format!("a change of level adds up to {} × the kinetic energy", figure(energy));
    findings.push(Finding::new(energy <= ENERGY, sentence));
    findings
}

fn schedule(json: &Value) -> Vec<Finding> {
    let finest = rows(json, "rows").iter().filter(|row| row["n"] == 33);
    let worst = finest.map(|row| number(row, "ratio")).fold(0.0, worse);
    let sentence =
        format!("the plugin takes {} × the time of plain calls, eight flags of 33²", figure(worst));
    vec![Finding::new(worst <= 1.0 + SCHEDULE, sentence)]
}

fn sharing(json: &Value) -> Vec<Finding> {
    let worst = |other: &str| {
        let ratios = rows(json, "rows").iter().map(|row| number(row, "us") / number(row, other));
        ratios.fold(0.0, worse)
    };
    let found = ["us_greatest", "us_mean"].map(worst);
    ["greatest", "mean"].into_iter().zip(found).zip(SHARED).map(|((name, ratio), limit)| {
        let sentence = format!(
            "flags by need take up to {} × the time of flags that all have the {name} number of substeps",
            figure(ratio)
        );
        Finding::new(ratio <= limit, sentence)
    })
    .collect()
}

/// Time of the fastest of this project's settings for a single cloth, compared with the least stretched of
/// the other engines.
fn peers(json: &Value) -> Vec<Finding> {
    let is_ours = |row: &&Value| text(row, "engine").starts_with("bunting");
    let on = |scene: &'static str| {
        let rows = rows(json, "rows").iter();
        rows.filter(move |row| text(row, "scene") == scene && row["lanes"] == 1)
    };
    let mut findings = Vec::new();
    for scene in ["hang_top", "hang_side", "hang_corners"] {
        let time = |row: &&Value| number(row, "ms_per_tick");
        let ours = on(scene).filter(is_ours).min_by(|a, b| time(a).total_cmp(&time(b)));
        let theirs = on(scene).filter(|row| !is_ours(row) && row["max_stretch"].is_number());
        let strain = |row: &Value| number(row, "max_stretch");
        let theirs = theirs.min_by(|a, b| strain(a).total_cmp(&strain(b)));
        let Some((ours, theirs)) = ours.zip(theirs) else { continue };
        let ratio = time(&theirs) / time(&ours);
        let [strain, other] = [ours, theirs].map(|row| figure(number(row, "max_stretch")));
        let sentence = format!(
            "{scene}: one cloth {} × as fast as {} at {} substeps, largest strain {strain} against \
             {other}",
            figure(ratio),
            text(theirs, "engine"),
            theirs["substeps"],
        );
        findings.push(Finding::new(ratio > 1.0, sentence));
    }
    findings
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn failing_cases_are_named_worst_first() {
        let case = |name, error, pass| json!({ "name": name, "relative_error": error, "tolerance": 1.0, "pass": pass });
        let json = json!({ "cases": [case("a", 0.1, true), case("b", 2.0, false), case("c", 9.0, false)] });
        let findings = of("oracles", &json);
        assert!(findings[0].good && findings[0].text.starts_with("1 of 3"));
        assert_eq!(findings[1].text, "2 of 3 fail, most: c (by 9.000 ×); b (by 2.000 ×)");
    }

    #[test]
    fn cases_not_built_count_for_nothing() {
        let json =
            json!({ "cases": [{ "name": "tearing", "pass": false, "status": "not_built" }] });
        assert!(of("stability", &json).is_empty());
    }

    #[test]
    fn a_rival_as_exact_is_compared_by_time() {
        let row = |method: &str, time: f64, error: f64| {
            json!({ "scene": "swing", "n": 9, "method": method, "lanes": 1, "stable": true,
                "us_per_cloth_tick": time, "rms_error_m": error })
        };
        let rows = [
            row("bunting yarns", 40.0, 1e-3),
            row("bunting yarns", 10.0, 1e-3),
            row("xpbd", 50.0, 1e-3),
            row("pbd", 5.0, 0.1),
        ];
        let findings = of("pareto", &json!({ "rows": rows }));
        assert!(findings[0].good && findings[0].text.contains("xpbd, takes 5.000 ×"));
    }

    #[test]
    fn a_link_that_is_stretched_too_far_is_not_good() {
        let row = json!({ "scene": "hang_side", "n": 9, "method": "bunting yarns", "lanes": 1,
            "substeps": DEFAULT.substeps, "passes": DEFAULT.passes, "max_stretch": 0.09 });
        let reference = json!({ "scene": "hang_side", "n": 9, "max_stretch": 0.01 });
        let findings = of("pareto", &json!({ "rows": [row], "references": [reference] }));
        assert_eq!(findings.len(), 1, "{findings:?}");
        assert!(!findings[0].good && findings[0].text.contains("9.00 %"), "{findings:?}");
    }
}
