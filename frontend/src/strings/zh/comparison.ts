import type { comparison as english } from "../en/comparison";

export const comparison: typeof english = {
  panel: "比较",
  list: "差异",
  count: (count) => `${count} 处差异`,
  same: "两个描述的内容相同。",
  old: "旧",
  new: "新",
  showOld: "以半透明方式显示旧机器人",
  showNew: "显示新机器人",
  alpha: "旧机器人的不透明度",
  marks: "为差异着色",
  marksHint: "新机器人中新增或有改动的连杆，以及旧机器人中已删除的连杆，以颜色标出",
  mark: { added: "新增", changed: "改动", removed: "删除", old: "旧" },
  kinds: { added: "新增", removed: "删除", renamed: "改名", changed: "改动" },
  subjects: { robot: "机器人", link: "连杆", joint: "关节", extension: "扩展" },
  nothing: "无",
  select: (name) => `选择 ${name} 并对准它`,
};
