//! The thread that traces the picture: a quarter of the size first, then whole ones, whose mean gets better and better.

use crate::bake::{BakeError, CancelToken, Picture, PictureSettings, REPLICATES, render_picture};
use crate::scene::{Camera, Scene};
use crate::trace::Transport;
use std::num::NonZeroUsize;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// How much smaller the first look is, along each side.
const FIRST_LOOK: u32 = 4;

/// What is traced.
#[derive(Clone)]
pub(super) struct Task {
    pub(super) scene: Arc<Scene>,
    pub(super) camera: Camera,
    pub(super) size: [u32; 2],
    pub(super) transport: Transport,
    /// Paths per pixel in the end.
    pub(super) samples: u32,
    pub(super) threads: Option<NonZeroUsize>,
}

/// What a look at the thread brings.
pub(super) enum News {
    /// A better picture, and how many paths went through each of its pixels.
    Picture(Box<Picture>, u32),
    /// It is as good as was asked for.
    Done,
    /// Nothing more comes of it.
    Failed(String),
}

/// The thread; dropped, it ends.
pub(super) struct Tracing {
    cancel: CancelToken,
    /// In a mutex only because a resource must be shareable.
    news: Mutex<Receiver<News>>,
}

impl Drop for Tracing {
    fn drop(&mut self) {
        self.cancel.cancel();
    }
}

impl Tracing {
    /// Starts it.
    pub(super) fn start(task: Task) -> Result<Self, String> {
        let (sender, receiver) = channel();
        let cancel = CancelToken::default();
        let their_cancel = cancel.clone();
        let worker = std::thread::Builder::new().name("kiln truth".into()).spawn(move || {
            let end = trace(&task, &sender, &their_cancel)
                .map_or_else(|error| News::Failed(error.to_string()), |()| News::Done);
            // Nobody listens any more once the comparison is over.
            let _ = sender.send(end);
        });
        worker.map_err(|error| format!("no thread could be started: {error}"))?;
        Ok(Self { cancel, news: Mutex::new(receiver) })
    }

    /// What has come since the last look, the latest of its pictures.
    pub(super) fn news(&self) -> Vec<News> {
        let receiver = self.news.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = Vec::new();
        loop {
            match receiver.try_recv() {
                Ok(News::Picture(picture, paths)) => {
                    all.retain(|news| !matches!(news, News::Picture(..)));
                    all.push(News::Picture(picture, paths));
                }
                Ok(end) => all.push(end),
                Err(TryRecvError::Empty | TryRecvError::Disconnected) => return all,
            }
        }
    }
}

fn trace(task: &Task, sender: &Sender<News>, cancel: &CancelToken) -> Result<(), BakeError> {
    let least = REPLICATES;
    let [width, height] = task.size;
    let small = [width.div_ceil(FIRST_LOOK), height.div_ceil(FIRST_LOOK)];
    let _ = sender.send(News::Picture(Box::new(pass(task, small, least, 0, cancel)?), 0));
    let mut mean: Option<Picture> = None;
    let (mut paths, mut number) = (0, 1);
    while paths < task.samples {
        // As many again as there are, so that passes stay few.
        let more = paths.max(least).min((task.samples - paths).next_multiple_of(least));
        let next = pass(task, task.size, more, number, cancel)?;
        let share = more as f32 / (paths + more) as f32;
        let picture = match mean.take() {
            None => next,
            Some(mut before) => {
                for (pixel, new) in before.radiance.iter_mut().zip(&next.radiance) {
                    *pixel = pixel.lerp(*new, share);
                }
                before
            }
        };
        (paths, number) = (paths + more, number + 1);
        let _ = sender.send(News::Picture(Box::new(picture.clone()), paths));
        mean = Some(picture);
    }
    Ok(())
}

/// One picture by itself: each has random numbers of its own.
fn pass(
    task: &Task,
    [width, height]: [u32; 2],
    paths: u32,
    number: u64,
    cancel: &CancelToken,
) -> Result<Picture, BakeError> {
    let transport = Transport { seed: task.transport.seed.wrapping_add(number), ..task.transport };
    let settings = PictureSettings { transport, width, height, samples_per_pixel: paths, threads: task.threads };
    render_picture(&task.scene, &task.camera, &settings, &(), cancel)
}
