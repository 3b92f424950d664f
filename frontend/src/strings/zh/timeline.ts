import type { timeline as english } from "../en/timeline";

export const timeline: typeof english = {
  label: "时间轴",
  position: "录制中的时间",
  play: "播放（空格）",
  pause: "暂停（空格）",
  back: "上一条消息（←）",
  forward: "下一条消息（→）",
  speed: "速度",
  loop: "到结尾后从头播放",
  keys: "录制：播放、暂停；单步",
};
