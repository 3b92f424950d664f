-- The default of each option of the map builder. Files of users include this file.
include "pose_graph.lua"

MAP_BUILDER = {
  pose_graph = POSE_GRAPH,
  use_trajectory_builder_2d = false,
  use_trajectory_builder_3d = false,
  collate_by_trajectory = false,
  num_background_threads = 4,
}
