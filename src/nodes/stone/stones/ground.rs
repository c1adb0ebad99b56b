//! All stones of a partition, and which of them are on top in a pixel.

use super::cage::Cage;
use super::depth::{Outline, Outlines};
use super::form::Form;
use super::grid::Grid;
use super::top::{self, Found, Nearest, Part, Pixel, Seen, Top};
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
    /// How far what is seen of it may end from its outline, and the height above which it does not end.
    pub(super) moved: f32,
    pub(super) flat: f32,
    /// Height at which wear has flattened it, and how far below it begins to.
    pub(super) worn: Option<[f32; 2]>,
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
    /// How far from stones a point is nearest to one, in mm.
    pub(super) reach: f32,
    /// Forms of stones that were looked at: they take long to make and much memory, so only some are kept.
    pub(super) forms: Vec<Mutex<KeptForm>>,
}

/// A form with the number of its stone, if one is kept.
pub(super) type KeptForm = Option<(u32, Arc<Form>)>;

/// Most forms that are kept: some ten megabytes.
pub(super) const FORMS: usize = 2048;

/// Where the rule of Gauss with two points looks, from the middle, as a share of the whole: 1 / (2 sqrt 3).
const GAUSS: f32 = 0.288_675_13;

/// Forms at hand, so that neighbouring points need not ask for them.
#[derive(Default)]
pub(super) struct Hand([Option<(u32, Arc<Form>)>; 8]);

impl Ground {
    /// Identifies all that points depend on.
    pub(super) fn key(&self) -> Key {
        let mut key = KeyHasher::new("stones", 1);
        self.grid.add_to_key(&mut key);
        key.number(f64::from(self.reach));
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
                stone.moved,
                stone.flat,
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

    /// What is on top in a pixel.
    #[inline]
    pub(super) fn find(&self, at: DVec2, pixel: &Pixel, hand: &mut Hand) -> Found {
        let mut top = Top::default();
        let mut nearest = Nearest::new(-self.reach);
        for near in self.grid.near(at) {
            let stone = &self.stones[*near as usize];
            let point = self.grid.apart(at, stone.centre).as_vec2();
            let outside = (stone.low - point).max(point - stone.high).max_element();
            if outside >= (0.5 * pixel.width).max(pixel.width - nearest.depth()) {
                continue;
            }
            let inside = self.outlines.depth(&stone.outline, point);
            nearest.add(*near, inside);
            let part = match stone.corners.is_empty() {
                true => stone.sett(inside, point, pixel.width),
                false => self.cut(*near, inside, point, pixel, hand),
            };
            if part.cover > 0.0 {
                top.add(*near, inside, part);
            }
        }
        let found = top.found(&nearest, pixel.width);
        match found.cover == 0.0 && found.share > 0.0 {
            true => Found {
                share: self.share(&found, at, pixel),
                ..found
            },
            false => found,
        }
    }

    /// The share of a pixel in a joint that is nearer to the other stone: that of four parts of it.
    fn share(&self, found: &Found, at: DVec2, pixel: &Pixel) -> f32 {
        let depth = |stone: Option<u32>, offset: Vec2| match stone {
            None => -self.reach,
            Some(stone) => {
                let stone = &self.stones[stone as usize];
                let point = self.grid.apart(at, stone.centre).as_vec2();
                self.outlines.depth(&stone.outline, point + offset)
            }
        };
        let parts = pixel.points.map(|offset| {
            let ahead = depth(found.stone, offset) - depth(found.other, offset);
            top::share(ahead, [found.stone, found.other], 0.5 * pixel.width)
        });
        0.25 * parts.iter().sum::<f32>()
    }

    /// What is seen of a prism, or of what is cut of it: at one point, or where it may end at four.
    #[inline]
    fn cut(&self, number: u32, depth: f32, point: Vec2, pixel: &Pixel, hand: &mut Hand) -> Part {
        let stone = &self.stones[number as usize];
        let doubtful = stone.moved + 0.7 * pixel.width;
        if depth < -doubtful {
            return Part::default();
        }
        let form = self.form(number, hand);
        let mut seen = Seen::default();
        let is_inside = depth > doubtful;
        if pixel.width == 0.0 || is_inside {
            let middle = form.height(point);
            if pixel.width == 0.0 || middle.is_some_and(|height| height > stone.flat) {
                seen.add(middle.map(|height| stone.settled(height, point)));
                return seen.part();
            }
        }
        for offset in pixel.points {
            let point = point + offset;
            seen.add(
                form.height(point)
                    .map(|height| stone.settled(height, point)),
            );
        }
        seen.part()
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
    /// What is seen of a sett: flat or a little domed on top, with a round rim.
    #[inline]
    fn sett(&self, depth: f32, point: Vec2, width: f32) -> Part {
        let cover = match width > 0.0 {
            true => (depth / width + 0.5).clamp(0.0, 1.0),
            false => f32::from(u8::from(depth > 0.0)),
        };
        let domed = self.top + self.crown * (1.0 - point.length_squared() * self.half);
        let top = self.settled(domed, point);
        let (from, to) = ((depth - 0.5 * width).max(0.0), depth + 0.5 * width);
        if from >= self.rim || cover <= 0.0 {
            return Part {
                height: top,
                range: 0.0,
                cover,
            };
        }
        let below = |depth: f32| {
            let left = (self.rim - depth).max(0.0);
            self.rim - (self.rim * self.rim - left * left).max(0.0).sqrt()
        };
        // The rule of Gauss with two points.
        let (middle, apart) = (0.5 * (from + to), GAUSS * (to - from));
        let lost = 0.5 * (below(middle - apart) + below(middle + apart));
        Part {
            height: top - lost,
            range: below(from) - below(to),
            cover,
        }
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
