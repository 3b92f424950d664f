import type { sharing as english } from "../en/sharing";

/** 导出、截图、录像；以及连接较慢时省略的内容。 */
export const sharing: typeof english = {
  slowLine: "连接较慢",
  slowLineHint: "机器人的运动优先传送；其余内容在连接变快之前以较低的细节显示。",
  points: (step) => `每 ${step} 个点取 1 个`,
  image: ({ columns, rows, width, height, quality }) => `WebP ${columns} × ${rows}（原图 ${width} × ${height}），质量 ${quality}`,
  share: "分享",
  screenshot: "截图",
  screenshotScaled: (scale) => `截图（${scale} 倍大小）`,
  startVideo: "录制视频",
  stopVideo: (time) => `停止录制（${time}）`,
  recording: "正在录制",
  exportHtml: "导出 HTML…",
  exportGlb: "导出 glb…",
  exportFailed: "无法导出机器人",
  exportOutside: "导出的文件包含下列软件包之外的文件的内容",
  exported: {
    made: (program) => `由 ${program} 生成`,
    joints: "关节",
    views: "视角",
    shown: "显示",
    visual: "可视",
    collision: "碰撞",
    start: "复位",
    startHint: "关节和视角恢复为文件中的样子",
    sides: { start: "初始", front: "前", left: "左", top: "上", iso: "斜角" },
    sidebar: "面板",
  },
};
