import type { terminal as english } from "../en/terminal";

/** 终端面板 */
export const terminal: typeof english = {
  panel: "终端",
  off: "终端未启用。启动程序时加上 --terminal，即可在这里使用你的 shell。",
  loading: "正在加载终端…",
  failed: "无法加载终端。",
  tabs: "终端",
  name: (id) => `终端 ${id}`,
  input: (id) => `终端 ${id}。按 Ctrl+Shift+M 离开终端。`,
  keys: "Ctrl+Shift+C 复制，Ctrl+Shift+V 粘贴，Ctrl+Shift+M 离开终端",
  copy: "复制选中的文字",
  paste: "粘贴",
  leave: "离开终端",
  tabKeys: "在标签上：显示上一个或下一个终端",
  new: "新建",
  newHint: "在另一个终端中启动你的 shell",
  close: "关闭",
  closeHint: "结束此终端中的程序，并移除终端",
  copyHint: "复制选中的文字（Ctrl+Shift+C）",
  readerHint: "让屏幕阅读器朗读终端",
  ended: (name) => `${name}（已结束）`,
  endedWith: (status) => (status < 0 ? `shell 被信号 ${-status} 结束。` : `shell 已结束，退出状态为 ${status}。`),
  restart: "重新启动",
  elsewhere: "此终端正显示在另一个页面中。",
  showHere: "在这里显示",
  inputLost: "此终端中的程序没有读取输入，部分输入已丢弃。",
};
