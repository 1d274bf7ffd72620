//! Run of the table.
