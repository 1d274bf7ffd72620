//! Document of the table.
