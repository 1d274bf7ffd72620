mod damage;
mod files;
mod kinds;
mod refusals;
mod sets;
