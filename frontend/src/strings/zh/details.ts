import type { details as en } from "../en/details";

export const details: typeof en = {
  Parent: "它所连接的坐标系。",
  Position: "它在固定坐标系中的位置，单位米。",
  Orientation: "它在固定坐标系中的姿态：四元数的 x、y、z、w。",
  "Relative Position": "它相对于父坐标系的位置，单位米。",
  "Relative Orientation": "它相对于父坐标系的姿态：四元数的 x、y、z、w。",
  Type: "关节的运动方式。",
  "Lower Limit": "关节位置的下限，单位弧度或米。",
  "Upper Limit": "关节位置的上限，单位弧度或米。",
  "Joint Axis": "关节在自身坐标系中的转轴或移动方向。",
  Effort: "关节最近一次的力矩，单位牛·米。",
  "Max Effort": "描述文件允许的最大力矩，单位牛·米。",
  Details: "已知的信息。",
};
