//! Contacts compared with closed forms, and with the shapes that must not pass through cloth.
//!
//! Every row is one figure of the product with default passes, and one limit.

#[cfg(feature = "peers")]
pub mod beside;
mod capstan;
mod cloths;
mod cost;
mod curtain;
mod drape;
mod fast;
mod in_app;
mod inside;
mod intersections;
mod itself;
mod lying;
mod pierced;
mod rest;
mod rig;
mod row;
mod shapes;
mod slope;
mod tablecloth;
mod torn;
mod turntable;

pub use row::Row;

/// Runs one family of rows; fewer and smaller where `quick`.
pub type Family = fn(quick: bool) -> Vec<Row>;

/// Every family with its name.
pub const ALL: [(&str, Family); 15] = [
    ("slope", slope::rows),
    ("capstan", capstan::rows),
    ("turntable", turntable::rows),
    ("rest", rest::rows),
    ("fast", fast::rows),
    ("inside", inside::rows),
    ("lying", lying::rows),
    ("cost", cost::rows),
    ("pierced", pierced::rows),
    ("curtain", curtain::rows),
    ("tablecloth", tablecloth::rows),
    ("torn", torn::rows),
    ("drape", drape::rows),
    ("itself", itself::rows),
    ("cloths", cloths::rows),
];
