//! Dilations with planted faults, each of which a judge of the properties must find.

use super::*;

/// Takes black for a hole, and closes it.
fn closes_black(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let owners = proper(field, workers);
    let is_hole = |index: &usize| field.is_measured(*index) && field.value[*index] == Vec3::ZERO;
    let holes: Vec<usize> = (0..field.value.len()).filter(is_hole).collect();
    for index in holes {
        field.value[index] = neighbours(field, index).map(|other| field.value[other]).fold(Vec3::ZERO, Vec3::max);
    }
    owners
}

/// Writes what was measured again, from its neighbours, by the least that there is.
fn rounds_measured(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let owners = proper(field, workers);
    let lit = (0..field.value.len()).find(|&index| field.is_measured(index) && field.value[index].x > 0.0);
    lit.into_iter().for_each(|index| field.value[index].x = field.value[index].x.next_up());
    owners
}

/// Fills from the mean of all covered neighbours, hidden ones among them.
fn reads_hidden(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let before = field.clone();
    let owners = proper(field, workers);
    for index in (0..before.value.len()).filter(|&index| before.state[index] == TexelState::Empty) {
        let covered = neighbours(&before, index).filter(|&other| before.state[other] != TexelState::Empty);
        let covered: Vec<Vec3> = covered.map(|other| before.value[other]).collect();
        if !covered.is_empty() {
            field.value[index] = covered.iter().sum::<Vec3>() / covered.len() as f32;
        }
    }
    owners
}

/// Blends what is filled with what stood there, by a hundred thousandth.
fn reads_what_stood_there(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let before = field.clone();
    let owners = proper(field, workers);
    for index in (0..before.value.len()).filter(|&index| !before.is_measured(index)) {
        if owners.source(index).is_some() {
            field.value[index] += 1e-5 * before.value[index];
        }
    }
    owners
}

/// Carries slopes on for ever.
fn overshoots(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let owners = proper(field, workers);
    for index in 0..field.value.len() {
        let Some(source) = owners.source(index).filter(|&source| source != index) else { continue };
        field.value[index] = field.value[source] + 4.0 * (field.value[index] - field.value[source]);
    }
    owners
}

/// A little light everywhere, black or not.
fn glows(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let owners = proper(field, workers);
    for index in 0..field.value.len() {
        if !field.is_measured(index) && owners.source(index).is_some() {
            field.value[index] += 1e-12;
        }
    }
    owners
}

/// Mixes what no link joins: other charts, and rooms behind walls.
fn reads_across_links(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let links = std::mem::replace(&mut field.links, vec![Links::ALL; field.value.len()]);
    let owners = proper(field, workers);
    field.links = links;
    owners
}

/// Adds a little for each thread.
fn counts_threads(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let owners = proper(field, workers);
    let threads = workers.gather_quietly(&[()], |(), _| Some(rayon::current_num_threads())).unwrap();
    let filled = (0..field.value.len()).find(|&index| owners.source(index).is_some_and(|source| source != index));
    filled.into_iter().for_each(|index| field.value[index] += 1e-6 * threads[0] as f32);
    owners
}

/// Forgets the blocks.
fn leaves_blocks(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let mut owners = proper(field, workers);
    let last = (0..field.value.len()).rfind(|&index| owners.source[index] != NONE && !field.is_measured(index));
    last.into_iter().for_each(|index| owners.source[index] = NONE);
    owners
}

/// Gives hidden texels the first chart.
fn forgets_charts(field: &mut Field, workers: &Workers<'_>) -> Owners {
    let mut owners = proper(field, workers);
    let first = (0..field.value.len()).find(|&index| field.is_measured(index));
    for index in (0..field.value.len()).filter(|&index| field.state[index] == TexelState::Hidden) {
        let Some(first) = first.filter(|_| owners.source(index).is_some()) else { continue };
        (owners.source[index], field.value[index]) = (first as u32, field.value[first]);
    }
    owners
}

/// Two charts with hidden and black texels, and what each of the faults makes of them.
#[test]
fn planted_faults_are_found() {
    let sketch =
        Sketch { size: [26, 22], charts: vec![[3, 4, 8, 9], [15, 5, 7, 10]], seed: 7, hidden: 3, black: 5, cut: 2 };
    let mut before = sketch.field();
    // A hidden texel on a border, in a row of black ones.
    for index in (4..13).map(|y| 26 * y + 10) {
        (before.state[index], before.value[index]) = (TexelState::Measured, Vec3::ZERO);
    }
    (before.state[26 * 8 + 10], before.links[26 * 8 + 10]) = (TexelState::Hidden, Links::default());
    assert_eq!(judge(proper, &before), Ok(()));
    let found = |dilation: Dilation, sentence: &str| {
        let (after, owners) = run(dilation, &before, 2);
        let verdict = match sentence {
            "measured" => keeps_what_was_measured(&before, &after, &owners),
            "not" => reads_only_what_was_measured(dilation, &before),
            "within" => stays_within_its_sources(&before, &after, &owners),
            "complete" => fills_rings_and_blocks(&before, &owners),
            _ => hidden_texels_go_by_their_own(&before, &owners),
        };
        let fault = verdict.expect_err(sentence);
        assert!(fault.contains(sentence), "{fault}");
        assert!(judge(dilation, &before).is_err());
    };
    found(closes_black, "measured");
    found(rounds_measured, "measured");
    found(reads_hidden, "not");
    found(reads_what_stood_there, "not");
    found(overshoots, "within");
    found(glows, "within");
    found(reads_across_links, "within");
    found(leaves_blocks, "complete");
    found(forgets_charts, "another chart");
    assert_eq!(is_the_same_on_all_threads(proper, &before), Ok(()));
    assert!(is_the_same_on_all_threads(counts_threads, &before).is_err());
}
