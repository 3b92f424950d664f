-- The defaults of mapping in space. Linkwright maps in the plane; files of users may still name these options.
MAX_3D_RANGE = 60
INTENSITY_THRESHOLD = 40

TRAJECTORY_BUILDER_3D = {
  min_range = 1, max_range = MAX_3D_RANGE,
  num_accumulated_range_data = 1,
  voxel_filter_size = 0.15,
  high_resolution_adaptive_voxel_filter = { max_length = 2, min_num_points = 150, max_range = 15 },
  low_resolution_adaptive_voxel_filter = { max_length = 4, min_num_points = 200, max_range = MAX_3D_RANGE },
  use_online_correlative_scan_matching = false,
  real_time_correlative_scan_matcher = {
    linear_search_window = 0.15, angular_search_window = math.rad(1),
    translation_delta_cost_weight = 0.1, rotation_delta_cost_weight = 0.1,
  },
  ceres_scan_matcher = {
    occupied_space_weight_0 = 1, occupied_space_weight_1 = 6, translation_weight = 5, rotation_weight = 400,
    intensity_cost_function_options_0 = {
      weight = 0.5, huber_scale = 0.3, intensity_threshold = INTENSITY_THRESHOLD,
    },
    only_optimize_yaw = false,
    ceres_solver_options = { use_nonmonotonic_steps = false, max_num_iterations = 12, num_threads = 1 },
  },
  motion_filter = { max_time_seconds = 0.5, max_distance_meters = 0.1, max_angle_radians = 0.004 },
  rotational_histogram_size = 120,
  imu_gravity_time_constant = 10,
  pose_extrapolator = {
    use_imu_based = false,
    constant_velocity = { imu_gravity_time_constant = 10, pose_queue_duration = 0.001 },
    imu_based = {
      pose_queue_duration = 5, gravity_constant = 9.806,
      pose_translation_weight = 1, pose_rotation_weight = 1,
      imu_acceleration_weight = 1, imu_rotation_weight = 1,
      odometry_translation_weight = 1, odometry_rotation_weight = 1,
      solver_options = { use_nonmonotonic_steps = false, max_num_iterations = 10, num_threads = 1 },
    },
  },
  submaps = {
    num_range_data = 160,
    high_resolution = 0.1, high_resolution_max_range = 20, low_resolution = 0.45,
    range_data_inserter = {
      hit_probability = 0.55, miss_probability = 0.49, num_free_space_voxels = 2,
      intensity_threshold = INTENSITY_THRESHOLD,
    },
  },
  use_intensities = false,
}
