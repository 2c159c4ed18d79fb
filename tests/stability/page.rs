//! The catalogue as a part of `docs/numerics.md`. `KILN_WRITE_SNAPSHOTS=1` writes it.

use crate::case::{Group, Verdict};
use crate::{cases, guard, seen};
use std::path::{Path, PathBuf};

const BEGIN: &str = "<!-- catalogue: written by tests/stability -->\n";
const END: &str = "<!-- end of the catalogue -->\n";

/// Whether the page shows the catalogue as it is.
pub fn is_up_to_date() -> Verdict {
    let path = page();
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let parts = text.split_once(BEGIN).and_then(|(head, rest)| Some((head, rest.split_once(END)?)));
    let Some((head, (there, tail))) = parts else {
        return Err(format!("{} has no place for the catalogue", path.display()));
    };
    let wanted = catalogue()?;
    if there == wanted {
        return Ok(());
    }
    if std::env::var_os("KILN_WRITE_SNAPSHOTS").is_some() {
        let text = [head, BEGIN, &wanted, END, tail].concat();
        return std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()));
    }
    Err("docs/numerics.md shows another catalogue: run with KILN_WRITE_SNAPSHOTS=1 and read the difference".into())
}

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/numerics.md")
}

fn catalogue() -> Result<String, String> {
    let seen = seen::load()?;
    let mut text = format!("\n{} cases, {} guards.\n", cases::all().len(), guard::all().len());
    text +=
        "\n\"Within 1 %\" counts four standard errors of what is measured in; \"to 1 %\" is of the number as it is.\n";
    for group in Group::ALL {
        text += &format!("\n### {}\n\n", group.title());
        text += "| case | what is hard | elsewhere | must hold here | guard | without it | seen then |\n";
        text += "|---|---|---|---|---|---|---|\n";
        for case in cases::of(group) {
            let said = seen.get(&case.full_name(group)).map_or("", |failure| &failure.message);
            let cells = [case.name, case.hard, case.elsewhere, case.holds, case.guard.name, case.without].join(" | ");
            text += &format!("| {cells} | {} |\n", said.replace('<', "&lt;"));
        }
    }
    text += "\n### Guards\n\n| guard | what it does | where |\n|---|---|---|\n";
    for guard in guard::all() {
        let mut files: Vec<String> = guard.edits.iter().map(|edit| format!("`{}`", edit.file)).collect();
        files.dedup();
        text += &format!("| {} | {} | {} |\n", guard.name, guard.does, files.join(", "));
    }
    text.push('\n');
    Ok(text)
}
