//! A picture in memory, [`FINE`] times larger than the saved picture. Lengths are given in pixels of the saved picture.

use std::io;
use std::path::Path;
use std::sync::Once;

use bsmpm_io::atomic;
use plotters::prelude::{BitMapBackend, DrawingBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontStyle, FontTransform, IntoFont, RGBColor, ShapeStyle, TextStyle, register_font,
};

use super::colour::{Rgb, WHITE};
use crate::Error;

/// How many times finer than the saved picture the drawing is.
pub(crate) const FINE: usize = 3;
const FONT: &str = "DejaVu Sans";
/// Plotters puts the top of a text half a size above the foot of its letters; a capital is 0.626 sizes high.
const CAPITAL_CENTRE: f64 = 0.5 - 0.626 / 2.0;

/// Where a text stands about its place; upright it is always centred on it.
#[derive(Clone, Copy)]
pub(crate) enum TextAlign {
    Left,
    Centre,
    Right,
}

pub(crate) struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
    failure: Option<String>,
}

impl Canvas {
    /// A white sheet.
    pub fn new(width: f64, height: f64) -> Self {
        let width = width.round() as usize;
        let height = height.round() as usize;
        let pixels = vec![WHITE[0]; 3 * FINE * FINE * width * height];
        Self {
            width,
            height,
            pixels,
            failure: None,
        }
    }

    fn draw(&mut self, with: impl FnOnce(&mut BitMapBackend) -> Result<(), String>) {
        let size = ((FINE * self.width) as u32, (FINE * self.height) as u32);
        let drawn = with(&mut BitMapBackend::with_buffer(&mut self.pixels, size));
        self.failure = self.failure.take().or(drawn.err());
    }

    /// A text whose capitals are centred upright on a place.
    pub fn text(&mut self, text: &str, [x, y]: [f64; 2], size: f64, align: TextAlign, colour: Rgb) {
        let place = fine([x, y - CAPITAL_CENTRE * size]).into();
        let style = style(size, align, colour, FontTransform::None);
        self.draw(|sheet| sheet.draw_text(text, &style, place).map_err(|error| error.to_string()));
    }

    /// A text that reads upward, centred on a place.
    pub fn upward(&mut self, text: &str, [x, y]: [f64; 2], size: f64, colour: Rgb) {
        let place = fine([x - CAPITAL_CENTRE * size, y]).into();
        let style = style(size, TextAlign::Centre, colour, FontTransform::Rotate270);
        self.draw(|sheet| sheet.draw_text(text, &style, place).map_err(|error| error.to_string()));
    }

    /// A filled triangle.
    pub fn triangle(&mut self, corners: [[f64; 2]; 3], colour: Rgb) {
        self.draw(|sheet| {
            let corners = corners.map(|corner| fine(corner).into());
            sheet
                .fill_polygon(corners, &filled(colour, 1.0))
                .map_err(|error| error.to_string())
        });
    }

    /// A line through `points` with round joints. Points nearer than half a pixel to the one before add nothing.
    pub fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, width: f64, colour: Rgb) {
        let style = filled(colour, width);
        let radius = (width * FINE as f64 / 2.0) as u32;
        self.draw(|sheet| {
            let mut from: Option<[f64; 2]> = None;
            for to in points {
                if let Some(last) = from {
                    if (to[0] - last[0]).hypot(to[1] - last[1]) < 0.5 {
                        continue;
                    }
                    sheet
                        .draw_line(fine(last).into(), fine(to).into(), &style)
                        .map_err(|error| error.to_string())?;
                }
                if radius > 2 {
                    sheet
                        .draw_circle(fine(to).into(), radius, &style, true)
                        .map_err(|error| error.to_string())?;
                }
                from = Some(to);
            }
            Ok(())
        });
    }

    /// A filled disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, colour: Rgb) {
        let radius = (radius * FINE as f64).round() as u32;
        self.draw(|sheet| {
            let style = filled(colour, 1.0);
            sheet
                .draw_circle(fine(centre).into(), radius, &style, true)
                .map_err(|error| error.to_string())
        });
    }

    /// A filled rectangle between its upper left and lower right corners.
    pub fn fill(&mut self, upper_left: [f64; 2], lower_right: [f64; 2], colour: Rgb) {
        let [left, top] = fine(upper_left);
        let [right, bottom] = fine(lower_right);
        for y in top..bottom {
            for x in left..right {
                self.dot([x, y], colour);
            }
        }
    }

    /// The outline of a rectangle between its upper left and lower right corners.
    pub fn frame(&mut self, [left, top]: [f64; 2], [right, bottom]: [f64; 2], width: f64, colour: Rgb) {
        let half = width / 2.0;
        for y in [top, bottom] {
            self.fill([left - half, y - half], [right + half, y + half], colour);
        }
        for x in [left, right] {
            self.fill([x - half, top - half], [x + half, bottom + half], colour);
        }
    }

    /// Colours one dot of the fine drawing; those outside the sheet are left out.
    pub fn dot(&mut self, place: [i32; 2], colour: Rgb) {
        let [Ok(x), Ok(y)] = place.map(usize::try_from) else {
            return;
        };
        if x < FINE * self.width && y < FINE * self.height {
            let at = 3 * (y * FINE * self.width + x);
            self.pixels[at..at + 3].copy_from_slice(&colour);
        }
    }

    /// Saves the sheet as a PNG picture, replacing the file in one go.
    ///
    /// # Errors
    /// [`Error::Drawing`] with the first thing that could not be drawn, [`Error::File`] when the system refuses.
    pub fn save(self, path: &Path) -> Result<(), Error> {
        if let Some(reason) = self.failure {
            return Err(Error::Drawing {
                path: path.to_owned(),
                reason,
            });
        }
        let averaged = self.averaged();
        atomic::replace(path, |file| {
            let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Rgb);
            encoder
                .write_header()
                .and_then(|mut picture| picture.write_image_data(&averaged))
                .map_err(io::Error::other)
        })?;
        Ok(())
    }

    fn averaged(&self) -> Vec<u8> {
        let mut averaged = Vec::with_capacity(3 * self.width * self.height);
        for y in 0..self.height {
            for x in 0..3 * self.width {
                let column = x / 3;
                let channel = x % 3;
                let mut sum = 0;
                for i in 0..FINE * FINE {
                    let dot = (FINE * y + i / FINE) * FINE * self.width + FINE * column + i % FINE;
                    sum += usize::from(self.pixels[3 * dot + channel]);
                }
                averaged.push(((sum + FINE * FINE / 2) / (FINE * FINE)) as u8);
            }
        }
        averaged
    }
}

/// The width of a text in pixels; 0 for one that cannot be drawn, which its drawing reports.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    font(size)
        .box_size(text)
        .map_or(0.0, |(width, _)| f64::from(width) / FINE as f64)
}

/// The size, at most `size`, at which a text is no wider than `room`.
pub(crate) fn fitting(text: &str, size: f64, room: f64) -> f64 {
    size.min(size * room / width(text, size).max(1.0))
}

fn font(size: f64) -> FontDesc<'static> {
    static FONT_ONCE: Once = Once::new();
    FONT_ONCE.call_once(|| {
        // A font that could not be read shows itself as the failure of the first text.
        let _ = register_font(FONT, FontStyle::Normal, include_bytes!("../../assets/DejaVuSans.ttf"));
    });
    (FONT, size * FINE as f64).into_font()
}

fn style(size: f64, align: TextAlign, colour: Rgb, turn: FontTransform) -> TextStyle<'static> {
    let across = match align {
        TextAlign::Left => HPos::Left,
        TextAlign::Centre => HPos::Center,
        TextAlign::Right => HPos::Right,
    };
    let mut style = TextStyle::from(font(size).transform(turn)).pos(Pos::new(across, VPos::Top));
    style.color = rgb(colour).to_backend_color();
    style
}

fn filled(colour: Rgb, width: f64) -> ShapeStyle {
    let stroke_width = (width * FINE as f64).round().max(1.0) as u32;
    ShapeStyle {
        color: rgb(colour).into(),
        filled: true,
        stroke_width,
    }
}

fn rgb([red, green, blue]: Rgb) -> RGBColor {
    RGBColor(red, green, blue)
}

/// A place of the picture in dots of the fine drawing.
pub(crate) fn fine(place: [f64; 2]) -> [i32; 2] {
    place.map(|pixels| (pixels * FINE as f64).round() as i32)
}
