//! One warning of the store in a run, however often it fails.

use crate::engine::event::{Event, Listener};
use crate::engine::render::Render;
use std::sync::atomic::{AtomicBool, Ordering};

/// Hears a run, and lets only its first [`Event::StoreFailed`] pass.
pub(in crate::engine) struct ToldOnce<'a> {
    listener: &'a dyn Listener,
    is_told: AtomicBool,
}

impl<'a> ToldOnce<'a> {
    pub(in crate::engine) fn new(listener: &'a dyn Listener) -> ToldOnce<'a> {
        ToldOnce {
            listener,
            is_told: AtomicBool::new(false),
        }
    }

    /// The request, heard by this.
    pub(in crate::engine) fn request<'b>(&'b self, request: &'b Render<'_>) -> Render<'b> {
        Render {
            graph: request.graph,
            folder: request.folder.clone(),
            only: request.only.clone(),
            pixels: request.pixels,
            listener: self,
            cancel: request.cancel.clone(),
        }
    }
}

impl Listener for ToldOnce<'_> {
    fn hear(&self, event: Event) {
        let is_failure = matches!(event, Event::StoreFailed { .. });
        if !is_failure || !self.is_told.swap(true, Ordering::Relaxed) {
            self.listener.hear(event);
        }
    }
}
