import type { timeline as english } from "../en/timeline";

export const timeline: typeof english = {
  label: "时间轴",
  position: "录制中的时间",
  play: "播放（空格）",
  pause: "暂停（空格）",
  back: "上一条消息（←）",
  forward: "下一条消息（→）",
  steps: "按哪个话题的消息单步",
  allSteps: "所有显示的",
  speed: "速度",
  loop: "到结尾后从头播放",
  live: "实时：回到当前时刻",
  liveShort: "实时",
  minutes: "最近几分钟内的时间",
  kept: (kept: string, most: string) => `已保留：${kept}，上限 ${most} MB`,
  more: "最旧的会被丢弃。要保留更多，启动程序时用 --history 指定内存，例如 --history 4GB。",
  keys: "录制、最近几分钟：播放、暂停；单步",
};
