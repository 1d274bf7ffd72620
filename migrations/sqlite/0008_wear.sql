-- Wear map of an abradable coating (postcard); null for the speeds of scenes without.
alter table speed_results add column wear blob;
