import { language, type Language } from "../../strings";

const PHRASES: Readonly<Record<Language, Readonly<Record<string, string>>>> = {
  en: {},
  zh: {
    "Completions": "补全",
    "Control character": "控制字符",
    "Diagnostics": "诊断",
    "No diagnostics": "没有诊断",
    "Go to line": "转到行",
    "go": "转到",
    "Selection deleted": "已删除选区",
    "close": "关闭",
    "current match": "当前匹配",
    "folded code": "已折叠的代码",
    "unfold": "展开",
    "to": "至",
    "Fold line": "折叠行",
    "Unfold line": "展开行",
    "Folded lines": "已折叠的行",
    "Unfolded lines": "已展开的行",
    "on line": "在行",
    "Find": "查找",
    "Replace": "替换",
    "next": "下一个",
    "previous": "上一个",
    "all": "全部",
    "match case": "区分大小写",
    "by word": "全词",
    "regexp": "正则表达式",
    "replace": "替换",
    "replace all": "全部替换",
    "replaced $ matches": "已替换 $ 处",
    "replaced match on line $": "已替换第 $ 行的匹配",
    "Formatting request failed": "无法格式化",
  },
};

/** CodeMirror's own texts in the language of the page, by the English ones. */
export const phrases = PHRASES[language];
