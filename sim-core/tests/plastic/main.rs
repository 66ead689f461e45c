//! Plastic discs against closed forms and the independent reference of `reference.csv` (case, H, quantity, x, y).

mod material_point;
mod reference;
