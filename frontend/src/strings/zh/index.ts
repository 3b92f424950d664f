import type { Strings } from "../en";
import { comparison } from "./comparison";
import { description } from "./description";
import { details } from "./details";
import { displays } from "./displays";
import { editing } from "./editing";
import { sourceEditor } from "./source-editor";
import { learning } from "./learning";
import { meshes } from "./meshes";
import { modeling } from "./modeling";
import { monitor } from "./monitor";
import { motionPlanning } from "./motion-planning";
import { recording } from "./recording";
import { sharing } from "./sharing";
import { shell } from "./shell";
import { simulation } from "./simulation";
import { timeline } from "./timeline";
import { tools } from "./tools";
import { turtlesim } from "./turtlesim";
import { values } from "./values";
import { terminal } from "./terminal";
import { voice } from "./voice";

/** 简体中文 */
export const zh: Strings = {
  panels: { ...description.panels,
    ...tools.panels, ...monitor.panels, displays: "显示", scene: "三维视图", views: "视角", joints: "关节", diagnostics: "诊断", world: modeling.panel, comparison: comparison.panel, voice: voice.panel, editing: editing.panel, terminal: terminal.panel, program: terminal.program, lesson: learning.lesson, checks: learning.checks, "motion-planning": motionPlanning.panel, turtlesim: turtlesim.panel },
  shell,
  sharing,
  simulation,
  meshes,
  timeline,
  values,
  recording,
  comparison,
  editing,
  sourceEditor,
  modeling,
  motionPlanning,
  voice,
  terminal,
  turtlesim,
  learning,
  details,
  displays,
  tree: {
    globalOptions: "全局选项",
    globalStatus: "全局状态",
    status: "状态",
    levels: { ok: "正常", loading: "加载中", warn: "警告", error: "错误" },
    notDrawn: "未绘制",
    notDrawnHelp: "Linkwright 会在文件中保留此显示项，但不绘制它。",
    enabledHelp: "打开或关闭此显示项。",
    pickColor: "选择颜色",
    frames: "已知坐标系",
    noNames: "没有已知的名称。",
  },
  views: tools.views,
  tools: tools.tools,
  selected: tools.selected,
  time: tools.time,
  transformation: tools.transformation,
  help: tools.help,
  visualTools: tools.visualTools,
  keys: tools.keys,
  description,
  joints: {
    randomize: "随机",
    randomizeHint: "把每个关节移到限位内的随机位置",
    center: "居中",
    centerHint: "把每个关节移到零位",
    radians: "弧度",
    degrees: "度",
    meters: "米",
    unitHint: "转动关节的单位",
    filter: "筛选关节",
    follows: (joint) => `跟随 ${joint}`,
    position: (joint) => `${joint} 的位置`,
    none: "没有可移动的关节。",
  },
  diagnostics: {
    none: "没有发现问题。",
    hint: "提示",
    note: "说明",
    withoutImages: "关闭图像显示",
    lastGood: "修复之前，保留上一个正确的机器人。",
    show: "查看",
    close: "关闭此消息",
    showDisplay: "在显示项列表中查看",
    more: (count) => `另有 ${count} 条`,
  },
  interactive: {
    menu: "右键：菜单。",
    modes: {
      menu: "单击：菜单。",
      button: "单击：触发。",
      move_axis: "拖动：沿轴移动。",
      move_plane: "拖动：在平面内移动。",
      rotate_axis: "拖动：绕轴旋转。",
      move_rotate: "拖动：移动并旋转。",
      move_3d: "拖动：移动。Shift+拖动：拉近或推远。",
      rotate_3d: "拖动：旋转。Shift+拖动：绕视线旋转。",
      move_rotate_3d: "拖动：移动。Shift：拉近或推远。Ctrl：旋转。Ctrl+Shift：绕视线旋转。",
    },
  },
  selection: {
    title: "选中的连杆",
    frame: "坐标系",
    joint: "父关节",
    source: "源文件",
    noPlace: "源文件位置未知。",
    copy: "复制位置",
    copied: "已复制",
    fold: "展开或收起连杆的信息",
    clear: "取消选择（Esc）",
  },
  scene: {
    label: "三维视图",
    frame: {
      missing: (name) => `坐标系 '${name}' 不存在`,
      hint: "它是固定坐标系：没有它，一切都没有位置。也许稍后有节点发布它。",
      use: (name) => `使用 ${name}`,
      useWithRobot: (name) => `使用 ${name} 并显示机器人`,
    },
    arguments: {
      label: "描述文件的参数",
      title: (file) => `${file} 需要参数`,
      known: "这些是其软件包的 launch 文件和测试所给的值。",
      unknown: "没有 launch 文件给出它们的值。",
      choose: "取值来自",
      show: "显示",
    },
    waiting: "正在等待机器人描述",
    keys: "三维视图。方向键旋转，Shift 加方向键平移，加号和减号缩放，F 看向所选对象，问号列出所有按键。",
    noWebgl: "三维视图需要 WebGL 2，而此浏览器不提供。",
    noWebglHelp: "请打开浏览器的硬件加速，或换用其他浏览器打开本页。其他面板不需要它，可以照常使用。",
  },
  connection: {
    connecting: "正在连接",
    connected: "已连接",
    reconnecting: "连接中断，正在重试",
    ended: "程序已结束",
    endedHint: "用同样的方式再次启动程序，本页就会继续。",
    refused: "这里现在运行着另一个程序",
    refusedHint: "请打开它给出的地址。",
    outdated: "本页与程序的版本不同。请关闭本页，重新打开程序给出的地址。",
  },
  door: {
    title: "打开本页需要 token",
    printed: "Linkwright 启动时在终端里打印页面的地址，其中带有 token：",
    hint: "请打开该地址，或粘贴在这里。已经打开的页面可以在“分享”中“复制链接”。",
    label: "地址或 token",
    open: "打开",
    unknown: "程序不认识这个 token：每个端口各有一个，一周后换新。",
    noToken: "这段文字里没有 token。",
  },
  status: {
    fps: (count) => `${count} 帧/秒`,
    idle: "空闲",
    fixedFrame: "固定坐标系",
    links: (count) => `${count} 个连杆`,
    noRobot: "没有机器人",
    slow: (fps) => `${fps}，页面较慢`,
    frames: (count) => `已绘制 ${count} 帧`,
  },
  monitor,
  close: "关闭",
  closeTab: "关闭（Delete）",
  suggestions: "建议",
  images: {
    none: "没有图像",
    unreadable: "无法读取图像",
    noCameraInfo: "没有 CameraInfo",
  },
};
