//! All stones of a partition, and which of them is on top at a point.

use super::cage::Cage;
use super::depth::{Outline, Outlines};
use super::form::Form;
use super::grid::Grid;
use crate::key::{Key, KeyHasher};
use glam::{DVec2, DVec3, Vec2};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// One stone, in mm around its centre.
#[derive(Clone, Debug)]
pub(super) struct Stone {
    pub(super) centre: DVec2,
    /// The box around its outline and all that is seen of it.
    pub(super) low: Vec2,
    pub(super) high: Vec2,
    pub(super) outline: Outline,
    /// The corners of its prism below and on top, in the list of all; none for a sett.
    pub(super) corners: Range<u32>,
    /// Height of the top, and how it rises along x and y.
    pub(super) top: f32,
    pub(super) slope: Vec2,
    /// Width of the rounding at the rim of a sett.
    pub(super) rim: f32,
    /// How far the middle of a sett's top stands above its rim, and over what distance it falls by that.
    pub(super) crown: f32,
    pub(super) half: f32,
    /// Height at which wear has flattened it, and how far below it begins to.
    pub(super) worn: Option<[f32; 2]>,
}

/// What is on top at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Height of the stone in mm; 0 where there is none.
    pub(super) height: f32,
    /// Whether there is a stone.
    pub(super) is_covered: bool,
    /// How far inside the outline of the stone the point is; below 0 outside.
    pub(super) depth: f32,
    /// The number of the stone, or of the nearest.
    pub(super) stone: Option<u32>,
}

/// All stones.
#[derive(Debug)]
pub(super) struct Ground {
    pub(super) stones: Vec<Stone>,
    pub(super) outlines: Outlines,
    pub(super) corners: Vec<DVec3>,
    /// The surfaces over prisms of so many corners; none for setts.
    pub(super) cages: BTreeMap<usize, Cage>,
    pub(super) grid: Grid,
    /// Forms of stones that were looked at: they take long to make and much memory, so only some are kept.
    pub(super) forms: Vec<Mutex<Option<(u32, Arc<Form>)>>>,
}

/// Most forms that are kept: some ten megabytes.
pub(super) const FORMS: usize = 2048;

/// Forms at hand, so that neighbouring points need not ask for them.
#[derive(Default)]
pub(super) struct Hand([Option<(u32, Arc<Form>)>; 8]);

impl Ground {
    /// Identifies all that points depend on.
    pub(super) fn key(&self) -> Key {
        let mut key = KeyHasher::new("stones", 1);
        self.grid.add_to_key(&mut key);
        for stone in &self.stones {
            let lengths = [stone.corners.len() as f64];
            let worn = stone.worn.unwrap_or([f32::MAX; 2]);
            let numbers = [
                stone.top,
                stone.slope.x,
                stone.slope.y,
                stone.rim,
                stone.crown,
                stone.half,
            ];
            let numbers = numbers.into_iter().chain(worn).map(f64::from);
            let all = stone
                .centre
                .to_array()
                .into_iter()
                .chain(lengths)
                .chain(numbers);
            all.for_each(|number| {
                key.number(number);
            });
        }
        let outlines = self.outlines.numbers().map(f64::from);
        let corners = self.corners.iter().flat_map(DVec3::to_array);
        outlines.chain(corners).for_each(|number| {
            key.number(number);
        });
        key.finish()
    }

    /// What is on top at a point.
    #[inline]
    pub(super) fn find(&self, at: DVec2, hand: &mut Hand) -> Found {
        let mut found = Found {
            height: 0.0,
            is_covered: false,
            depth: -self.grid.reach,
            stone: None,
        };
        for near in self.grid.near(at) {
            let stone = &self.stones[*near as usize];
            let point = self.grid.apart(at, stone.centre).as_vec2();
            let outside = (stone.low - point).max(point - stone.high).max_element();
            if outside < -found.depth.min(0.0) {
                self.look_at(*near, point, hand, &mut found);
            }
        }
        found
    }

    #[inline]
    fn look_at(&self, number: u32, point: Vec2, hand: &mut Hand, found: &mut Found) {
        let stone = &self.stones[number as usize];
        let depth = self.outlines.depth(&stone.outline, point);
        let height = match stone.corners.is_empty() {
            true => stone.sett(depth, point),
            false => self.form(number, hand).height(point),
        };
        let height = height.map(|height| stone.settled(height, point));
        let is_better = match height {
            Some(height) => !found.is_covered || height > found.height,
            None => !found.is_covered && depth > found.depth,
        };
        if is_better {
            *found = Found {
                height: height.unwrap_or_default(),
                is_covered: height.is_some(),
                depth: depth.max(-self.grid.reach),
                stone: Some(number),
            };
        }
    }

    /// The form of a stone, from the hand, from those that are kept, or made anew.
    fn form<'h>(&self, number: u32, hand: &'h mut Hand) -> &'h Form {
        let place = &mut hand.0[number as usize % 8];
        if place.as_ref().is_none_or(|held| held.0 != number) {
            *place = Some((number, self.kept(number)));
        }
        let held = place.as_ref().expect("was put there");
        &held.1
    }

    fn kept(&self, number: u32) -> Arc<Form> {
        let slot = &self.forms[number as usize % self.forms.len()];
        // Who holds the lock makes no difference to what a form is, so one that was left poisoned serves as well.
        let mut slot = slot
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        match &*slot {
            Some((kept, form)) if *kept == number => Arc::clone(form),
            _ => {
                let form = Arc::new(self.new_form(number));
                *slot = Some((number, Arc::clone(&form)));
                form
            }
        }
    }

    pub(super) fn new_form(&self, number: u32) -> Form {
        let range = self.stones[number as usize].corners.clone();
        let corners = &self.corners[range.start as usize..range.end as usize];
        Form::new(&self.cages[&(corners.len() / 2)], corners)
    }
}

impl Stone {
    /// The height of a sett: flat or a little domed on top, with a round rim.
    #[inline]
    fn sett(&self, depth: f32, point: Vec2) -> Option<f32> {
        if depth <= 0.0 {
            return None;
        }
        let left = (self.rim - depth).max(0.0);
        let rim = self.rim - (self.rim * self.rim - left * left).max(0.0).sqrt();
        Some(self.top - rim + self.crown * (1.0 - point.length_squared() * self.half))
    }

    /// The height as the stone lies in the ground, flattened where it is worn.
    #[inline]
    fn settled(&self, height: f32, point: Vec2) -> f32 {
        let height = match self.worn {
            Some([worn, soft]) => {
                let above = height - worn;
                height - 0.5 * (above + (above * above + soft * soft).sqrt())
            }
            None => height,
        };
        height + self.slope.dot(point)
    }
}
