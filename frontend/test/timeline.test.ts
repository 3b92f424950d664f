import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { formatAge, formatClock, computeDensities, formatExtent, formatMoment, formatElapsed } from "../src/panels/timeline/timeline-text";
import type { PageMessage, Playhead } from "../src/protocol";
import { TimelineState } from "../src/state/timeline";

function createPlayhead(part: Partial<Playhead> = {}): Playhead & { type: "playhead" } {
  return { type: "playhead", position: 100, playing: false, speed: 1, loop: false, seeks: 0, problem: "", live: false, ...part };
}

describe("the timeline", () => {
  let sentMessages: PageMessage[];
  let connection: Connection;
  let timeline: TimelineState;

  beforeEach(() => {
    sentMessages = [];
    connection = new Connection("ws://localhost/ws");
    vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
    timeline = new TimelineState(connection);
    connection.message.emit({ type: "timeline", name: "drive", start: 100, end: 110, topics: [], live: false });
    connection.message.emit(createPlayhead());
  });

  it("moves to where the user drags it, and requests one time after another, only the newest", () => {
    for (const position of [102, 103, 104]) timeline.seek(position);
    expect(timeline.position).toBe(104);
    expect(sentMessages).toEqual([{ type: "seek_time", position: 102 }]);
    connection.message.emit(createPlayhead({ position: 100.2, playing: true }));
    expect(timeline.position, "sent before the server reached the requested time").toBe(104);
    connection.message.emit(createPlayhead({ position: 102, seeks: 1 }));
    expect(sentMessages[1]).toEqual({ type: "seek_time", position: 104 });
    expect(timeline.position).toBe(104);
    connection.message.emit(createPlayhead({ position: 104, seeks: 2 }));
    expect(sentMessages).toHaveLength(2);
    connection.message.emit(createPlayhead({ position: 104.1, seeks: 2, playing: true }));
    expect(timeline.position).toBe(104.1);
  });

  it("stays within the recording", () => {
    timeline.seek(200);
    expect(sentMessages).toEqual([{ type: "seek_time", position: 110 }]);
  });

  it("reports changes separately from time that passes", () => {
    const events: string[] = [];
    timeline.changed.on(() => events.push("changed"));
    timeline.moved.on(() => events.push("moved"));
    connection.message.emit(createPlayhead({ playing: true }));
    connection.message.emit(createPlayhead({ playing: true, position: 100.1 }));
    connection.message.emit(createPlayhead({ playing: true, position: 100.2, loop: true }));
    expect(events).toEqual(["changed", "moved", "changed"]);
  });

  it("stays at the end of the history while live", () => {
    connection.message.emit({ type: "timeline", name: "", start: 100, end: 110, topics: [], live: true });
    connection.message.emit(createPlayhead({ live: true }));
    connection.message.emit({ type: "history_extent", start: 105, end: 120, size: 5e6, max_size: 1e7 });
    expect([timeline.isPlaying, timeline.isLive, timeline.position]).toEqual([true, true, 120]);
    timeline.setPlaying(false);
    connection.message.emit(createPlayhead({ position: 119 }));
    expect([timeline.isPlaying, timeline.isLive, timeline.position]).toEqual([false, false, 119]);
    expect(formatAge(1)).toBe("−0:01.000");
    expect(formatMoment(52.304)).toBe("0:52.304");
    expect(formatMoment(new Date(2026, 1, 3, 14, 3, 7, 256).getTime() / 1000)).toBe("14:03:07.256");
    expect(formatExtent({ type: "history_extent", start: 105, end: 120, size: 5e6, max_size: 1e7 })).toBe("0:15 · 5.0 MB");
    timeline.goLive();
    expect(sentMessages).toEqual([{ type: "play", playing: false }, { type: "go_live" }]);
  });

  it("disappears with a program that has none", () => {
    connection.message.emit({ type: "hello", protocol: 1, version: "", title: "", run: "1" });
    expect(timeline.timeline).toBeNull();
  });
});

describe("texts of the timeline", () => {
  it("show times as minutes and seconds", () => {
    expect(formatElapsed(7.256, 90)).toBe("0:07.256 / 1:30");
    expect(formatElapsed(59.9999, 3725)).toBe("1:00.000 / 1:02:05");
    expect(formatElapsed(1, 2.5)).toBe("0:01.000 / 0:02.500");
    expect(formatClock(1_700_000_000.25)).toContain(".250 (1700000000.250)");
  });

  it("show the density of messages relative to the densest part of each topic", () => {
    const createTopic = (name: string, counts: number[]) => ({ name, kind: "", count: counts.reduce((a, b) => a + b, 0), counts });
    const rows = computeDensities([createTopic("/a", [1, 0]), createTopic("/b", [2, 4]), createTopic("/c", [])]);
    expect(rows.map((row) => row.map((density) => Math.round(density * 100)))).toEqual([[34, 60], [60, 0]]);
  });
});
