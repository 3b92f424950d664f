import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { LogLine, PageMessage } from "../src/protocol";
import { formatBandwidth, formatRate } from "../src/state/monitor/figure-text";
import { levelOf, formatLine, LogState, MAX_RECORDS } from "../src/state/monitor/log";
import { ParametersState } from "../src/state/monitor/parameters";
import { formatParameter, parseParameter } from "../src/state/monitor/parameter-text";
import { TeleopState } from "../src/state/monitor/teleop";
import { motionOfKey, NO_MOTION, computeDeflection, sumMotions } from "../src/state/monitor/teleop-keys";
import { TopicsState } from "../src/state/monitor/topics";

let sentMessages: PageMessage[];
let connection: Connection;
let texts: Map<string, string>;
const storage = {
  getItem: (key: string) => texts.get(key) ?? null,
  setItem: (key: string, text: string) => void texts.set(key, text),
};

beforeEach(() => {
  sentMessages = [];
  texts = new Map();
  vi.useFakeTimers();
  vi.stubGlobal("window", { setTimeout });
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("topics", () => {
  it("are listed while a list of topics is visible", () => {
    const topics = new TopicsState(connection);
    const [firstPanel, secondPanel] = [{}, {}];
    topics.watchList(firstPanel, true);
    topics.watchList(secondPanel, true);
    topics.watchList(firstPanel, false);
    expect(sentMessages).toEqual([{ type: "watch_topics", wants_list: true, measured_topics: [], opened_topics: [] }]);
    topics.watchList(secondPanel, false);
    expect(sentMessages.at(-1)).toMatchObject({ wants_list: false });
  });

  it("are dropped when they are no longer measured", () => {
    const topics = new TopicsState(connection);
    topics.watch(["/a", "/b"], []);
    const traffic = ["/a", "/b"].map((topic) => ({ topic, rate: 1, bandwidth: 2, error: null }));
    connection.message.emit({ type: "topic_figures", traffic });
    topics.watch(["/b"], []);
    expect([...topics.traffic.keys()]).toEqual(["/b"]);
  });

  it("have readable figures", () => {
    expect([12, 1500, 45_678, 2.5e6, 3e9].map(formatBandwidth)).toEqual(["12 B/s", "1.50 KB/s", "45.7 KB/s", "2.50 MB/s", "3.00 GB/s"]);
    expect([0.2, 29.97, 1000.4].map(formatRate)).toEqual(["0.20", "30.0", "1000"]);
  });
});

describe("texts of parameters", () => {
  it("show lists in brackets", () => {
    expect(formatParameter("double", ["1.5"])).toBe("1.5");
    expect(formatParameter("integer_array", ["1", "2"])).toBe("[1, 2]");
    expect(formatParameter("string_array", ["a", 'b"c'])).toBe('["a", "b\\"c"]');
    expect(formatParameter("bool_array", [])).toBe("[]");
  });

  it("are parsed", () => {
    expect(parseParameter("string", "[a, b]")).toEqual(["[a, b]"]);
    expect(parseParameter("integer_array", "[1, 2]")).toEqual(["1", "2"]);
    expect(parseParameter("double_array", "1.5, 2")).toEqual(["1.5", "2"]);
    expect(parseParameter("string_array", '["a, b", "c"]')).toEqual(["a, b", "c"]);
    expect(parseParameter("string_array", "a, b c")).toEqual(["a", "b c"]);
    expect(parseParameter("string_array", "[]")).toEqual([]);
    expect(parseParameter("string_array", '["a, b]')).toBeNull();
  });

  it("survive formatting and parsing", () => {
    const values = ["", "a,b", 'say "x"', "[1]", "ü"];
    expect(parseParameter("string_array", formatParameter("string_array", values))).toEqual(values);
  });
});

describe("parameters", () => {
  it("are those of the selected node", () => {
    const parameters = new ParametersState(connection);
    parameters.watch(true);
    parameters.chooseNode("/a");
    connection.message.emit({ type: "node_parameters", node: "/b", parameters: [], error: null });
    expect(parameters.parameters).toBeNull();
    connection.message.emit({ type: "node_parameters", node: "/a", parameters: [], error: null });
    expect(parameters.parameters?.node).toBe("/a");
    parameters.watch(false);
    expect(sentMessages.at(-1)).toEqual({ type: "watch_parameters", wants_list: false, node: null });
  });
});

function createLine(part: Partial<LogLine>): LogLine {
  return { level: 20, node: "talker", message: "hello", time: 1.5, file: "", function: "", line: 0, ...part };
}

describe("the log", () => {
  const receive = (lines: LogLine[], missedCount = 0): void => connection.message.emit({ type: "log_lines", lines, missed: missedCount });

  it("shows the records that pass the filters", () => {
    const log = new LogState(connection, storage);
    receive([createLine({ level: 10 }), createLine({ level: 40, node: "base", message: "Hot" }), createLine({})]);
    log.setLevel(10, false);
    expect(log.shownLines.map(({ level }) => level)).toEqual([40, 20]);
    log.setNode("base");
    expect(log.shownLines.map(({ message }) => message)).toEqual(["Hot"]);
    log.setNode("");
    log.setText("hO");
    expect(log.shownLines).toHaveLength(1);
    expect(log.nodes).toEqual(["base", "talker"]);
    expect(new LogState(connection, storage).levels.has(10)).toBe(false);
  });

  it("is frozen while paused, and then shows all that arrived", () => {
    const log = new LogState(connection, storage);
    log.setPaused(true);
    receive([createLine({})]);
    expect(log.lines).toHaveLength(0);
    log.setPaused(false);
    expect(log.shownLines).toHaveLength(1);
  });

  it("keeps a limited number of records", () => {
    const log = new LogState(connection, storage);
    for (let block = 0; block < 45; block++) {
      receive(Array.from({ length: 1000 }, (_, index) => createLine({ message: String(block * 1000 + index) })), 1);
    }
    expect(log.lines.length).toBeLessThanOrEqual(MAX_RECORDS);
    expect(log.shownLines).toHaveLength(log.lines.length);
    expect(log.shownLines.at(-1)?.message).toBe("44999");
    expect(log.missedCount).toBe(45);
  });

  it("is copied in the format of the console", () => {
    const text = formatLine(createLine({ level: 30, file: "/x/talker.py", line: 7 }), "WARN");
    expect(text).toBe("[WARN] [1.500000000] [talker]: hello (/x/talker.py:7)");
    expect([5, 10, 25, 50, 99].map((level) => levelOf({ level }))).toEqual([10, 10, 20, 50, 50]);
  });
});

describe("driving", () => {
  const listDrives = (): number[][] =>
    sentMessages.flatMap((message) => (message.type === "drive" ? [[message.linear[0] ?? 0, message.angular[2] ?? 0]] : []));

  it("by keys works as in teleop_twist_keyboard", () => {
    expect(motionOfKey("i", false)).toEqual({ ...NO_MOTION, x: 1 });
    expect(motionOfKey("m", false)).toEqual({ ...NO_MOTION, x: -1, turn: -1 });
    expect(motionOfKey(".", false)).toEqual({ ...NO_MOTION, x: -1, turn: 1 });
    expect(motionOfKey("J", true)).toEqual({ ...NO_MOTION, y: 1 });
    expect(motionOfKey("ArrowLeft", true)).toEqual({ ...NO_MOTION, y: 1 });
    expect(motionOfKey("a", false)).toEqual({ ...NO_MOTION, turn: 1 });
    expect(motionOfKey("x", false)).toBeNull();
    expect(sumMotions([motionOfKey("w", false)!, motionOfKey("i", false)!, motionOfKey("a", false)!])).toEqual({ ...NO_MOTION, x: 1, turn: 1 });
  });

  it("by a stick has a dead zone in the middle", () => {
    expect([0.1, -0.1, 1, -1].map((value) => computeDeflection(value))).toEqual([0, 0, 1, -1]);
    expect(computeDeflection(0.5)).toBeGreaterThan(0.4);
  });

  it("repeats the command while a key is held and ends with a single zero", () => {
    const teleop = new TeleopState(connection, storage);
    teleop.setOpen(true);
    expect(sentMessages.at(-1)).toEqual({ type: "aim_teleop", target: { topic: "/cmd_vel", kind: "auto", frame_id: "base_link" } });
    teleop.configure({ linear: 2, angular: 3 });
    teleop.move("keys", { ...NO_MOTION, x: 1 });
    vi.advanceTimersByTime(500);
    expect(listDrives()).toHaveLength(11);
    expect(listDrives()[0]).toEqual([2, 0]);
    teleop.move("pad", { ...NO_MOTION, turn: -0.5 });
    vi.advanceTimersByTime(50);
    expect(listDrives().at(-1)).toEqual([2, -1.5]);
    teleop.move("keys", NO_MOTION);
    teleop.move("pad", NO_MOTION);
    vi.advanceTimersByTime(500);
    expect(listDrives().filter(([x, turn]) => x === 0 && turn === 0)).toHaveLength(1);
    expect(listDrives().at(-1)).toEqual([0, 0]);
  });

  it("stops when the panel is closed or the connection is lost", () => {
    const teleop = new TeleopState(connection, storage);
    teleop.setOpen(true);
    teleop.move("keys", { ...NO_MOTION, x: 1 });
    teleop.setOpen(false);
    expect(sentMessages.slice(-2).map(({ type }) => type)).toEqual(["drive", "aim_teleop"]);
    teleop.setOpen(true);
    teleop.move("keys", { ...NO_MOTION, x: 1 });
    connection.stateChanged.emit("reconnecting");
    expect(teleop.motion).toEqual(NO_MOTION);
    const count = listDrives().length;
    vi.advanceTimersByTime(500);
    expect(listDrives()).toHaveLength(count);
  });

  it("stores its settings", () => {
    new TeleopState(connection, storage).configure({ topic: "/robot/cmd_vel", rate: 10 });
    expect(new TeleopState(connection, storage).settings).toMatchObject({ topic: "/robot/cmd_vel", rate: 10, linear: 0.5 });
    texts.set("linkwright.teleop.1", "{");
    expect(new TeleopState(connection, storage).settings.topic).toBe("/cmd_vel");
  });
});
