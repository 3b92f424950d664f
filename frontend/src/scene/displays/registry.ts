import { BoxesDrawing } from "./boxes";
import { CameraDrawing } from "./camera";
import { CloudDrawing } from "./cloud";
import { ImageDrawing } from "./image";
import { MapDrawing } from "./map";
import type { DrawingClass } from "./drawing";
import { AxesDrawing } from "./axes";
import { DetectionImageDrawing } from "./detection-image";
import { EffortDrawing } from "./effort";
import { GridCellsDrawing } from "./grid-cells";
import { GridDrawing } from "./grid";
import { GridMapDrawing } from "./grid-map";
import { InteractiveMarkersDrawing } from "./interactive-markers";
import { MarkersDrawing } from "./markers";
import { MotionPlanningDrawing } from "./motion-planning";
import { OverlayDrawing } from "./overlay";
import { ParticleCloudDrawing } from "./particle-cloud";
import { PathDrawing } from "./path";
import { PointStampedDrawing } from "./point-stamped";
import { PolygonDrawing } from "./polygon";
import { PoseArrayDrawing } from "./pose-array";
import { PosesDrawing } from "./poses";
import { RangeDrawing } from "./range";
import { RobotModelDrawing } from "./robot-model";
import { ScrewDrawing } from "./screw";
import { TfDrawing } from "./tf";
import { WorldDrawing } from "./world";

/** The display classes that this page draws, by RViz's names. A new display needs one line here and one class. */
export const DRAWINGS: ReadonlyMap<string, DrawingClass> = new Map<string, DrawingClass>([
  ["rviz_default_plugins/Axes", AxesDrawing],
  ["rviz_default_plugins/Grid", GridDrawing],
  ["rviz_default_plugins/AccelStamped", ScrewDrawing],
  ["rviz_default_plugins/Effort", EffortDrawing],
  ["rviz_default_plugins/Odometry", PosesDrawing],
  ["grid_map_rviz_plugin/GridMap", GridMapDrawing],
  ["nav2_rviz_plugins/ParticleCloud", ParticleCloudDrawing],
  ["rviz_default_plugins/Path", PathDrawing],
  ["rviz_default_plugins/Polygon", PolygonDrawing],
  ["rviz_default_plugins/Pose", PosesDrawing],
  ["rviz_default_plugins/PoseArray", PoseArrayDrawing],
  ["rviz_default_plugins/PoseWithCovariance", PosesDrawing],
  ["rviz_default_plugins/Range", RangeDrawing],
  ["rviz_default_plugins/TwistStamped", ScrewDrawing],
  ["rviz_default_plugins/Wrench", ScrewDrawing],
  ["rviz_default_plugins/InteractiveMarkers", InteractiveMarkersDrawing],
  ["rviz_default_plugins/Marker", MarkersDrawing],
  ["rviz_default_plugins/MarkerArray", MarkersDrawing],
  ["rviz_default_plugins/PointStamped", PointStampedDrawing],
  ["rviz_default_plugins/RobotModel", RobotModelDrawing],
  ["rviz_default_plugins/TF", TfDrawing],
  ["rviz_default_plugins/FluidPressure", CloudDrawing],
  ["rviz_default_plugins/Illuminance", CloudDrawing],
  ["rviz_default_plugins/LaserScan", CloudDrawing],
  ["rviz_default_plugins/PointCloud", CloudDrawing],
  ["rviz_default_plugins/PointCloud2", CloudDrawing],
  ["rviz_default_plugins/RelativeHumidity", CloudDrawing],
  ["rviz_default_plugins/Temperature", CloudDrawing],
  ["rviz_default_plugins/GridCells", GridCellsDrawing],
  ["rviz_default_plugins/DepthCloud", CloudDrawing],
  ["rviz_default_plugins/Camera", CameraDrawing],
  ["rviz_default_plugins/Image", ImageDrawing],
  ["rviz_default_plugins/Map", MapDrawing],
  ["vision_msgs_rviz_plugins/BoundingBox3D", BoxesDrawing],
  ["vision_msgs_rviz_plugins/BoundingBox3DArray", BoxesDrawing],
  ["vision_msgs_rviz_plugins/Detection3D", BoxesDrawing],
  ["vision_msgs_rviz_plugins/Detection3DArray", BoxesDrawing],
  ["moveit_rviz_plugin/MotionPlanning", MotionPlanningDrawing],
  ["linkwright/Detections", DetectionImageDrawing],
  ["rviz_2d_overlay_plugins/TextOverlay", OverlayDrawing],
  ["linkwright/World", WorldDrawing],
]);
