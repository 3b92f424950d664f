import type { simulation as english } from "../en/simulation";

export const simulation: typeof english = {
  label: "仿真",
  play: "继续仿真",
  pause: "暂停仿真",
  step: "前进一步",
  reset: "重新开始：时间归零，所有模型回到原位",
  factorHint: "每一真实秒对应的仿真秒数",
  timeHint: "仿真时间",
  spawn: "添加模型",
  spawnTitle: "向世界添加模型",
  spawnHere: "在这里添加模型…",
  address: "文件",
  addressHint: "路径、package://… 或 model://…",
  position: "位置（米）",
  follow: (frame: string): string => `视角跟随 ${frame}`,
  remove: (model: string): string => `移除 ${model}`,
  dragKeys: "Ctrl + 拖动",
  dragModel: "移动仿真中的模型",
  pushKeys: "Ctrl + Shift + 拖动",
  pushModel: "用力拉动连杆",
};
