import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { formatAmount, formatSize } from "../src/panels/timeline/timeline-text";
import type { PageMessage, RecordedFile, RecordingState } from "../src/protocol";
import { RecordingControl } from "../src/state/recording";
import { TimelineState } from "../src/state/timeline";

function createState(part: Partial<RecordingState> = {}): RecordingState {
  return { type: "recording_state", possible: true, path: "", length: 0, size: 0, saved: null, problem: "", files: [], ...part };
}

const FILE: RecordedFile = { name: "rosbag2_1", path: "/home/me/rosbag2_1", size: 1e6, length: 3, url: "/export/a/b.mcap", simulated: null };

describe("recording", () => {
  let sentMessages: PageMessage[];
  let connection: Connection;
  let recording: RecordingControl;

  beforeEach(() => {
    sentMessages = [];
    connection = new Connection("ws://localhost/ws");
    vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
    recording = new RecordingControl(connection);
    connection.message.emit(createState());
  });

  it("offers the file only to the page that requested it", () => {
    const offeredFiles: RecordedFile[] = [];
    const otherOfferedFiles: RecordedFile[] = [];
    const otherRecording = new RecordingControl(connection);
    connection.message.emit(createState());
    recording.finished.on((file) => offeredFiles.push(file));
    otherRecording.finished.on((file) => otherOfferedFiles.push(file));
    recording.record([]);
    connection.message.emit(createState({ path: FILE.path, length: 1, size: 10 }));
    expect([recording.isRecording, otherRecording.isRecording, otherRecording.size]).toEqual([true, true, 10]);
    recording.stop();
    connection.message.emit(createState({ files: [FILE] }));
    expect(offeredFiles).toEqual([FILE]);
    expect(otherOfferedFiles).toEqual([]);
    expect(sentMessages.map(({ type }) => type)).toEqual(["record_topics", "stop_recording"]);
  });

  it("reports once why it ended early", () => {
    const reasons: string[] = [];
    recording.refused.on((text) => reasons.push(text));
    recording.record(["/tf"]);
    connection.message.emit(createState({ path: FILE.path }));
    connection.message.emit(createState({ problem: "the disk is full", files: [FILE] }));
    connection.message.emit(createState({ problem: "the disk is full", files: [FILE] }));
    expect(reasons).toEqual(["the disk is full"]);
    expect(recording.files).toEqual([FILE]);
  });

  it("is impossible before the program allows it, or during another recording", () => {
    connection.message.emit({ type: "hello", protocol: 0, version: "", title: "", run: "1" });
    expect(recording.isPossible).toBe(false);
    connection.message.emit(createState({ possible: false }));
    expect(recording.isPossible).toBe(false);
  });

  it("formats bytes and seconds", () => {
    expect(formatAmount(75, 4.5e6)).toBe("1:15 · 4.5 MB");
    expect(formatSize(2.345e9)).toBe("2.35 GB");
    expect(formatSize(45_100)).toBe("45 kB");
  });
});

describe("the marked part of the history", () => {
  let connection: Connection;
  let timeline: TimelineState;

  beforeEach(() => {
    connection = new Connection("ws://localhost/ws");
    timeline = new TimelineState(connection);
    connection.message.emit({ type: "timeline", name: "", start: 100, end: 110, topics: [], live: true });
    connection.message.emit({ type: "playhead", position: 104, playing: false, speed: 1, loop: false, seeks: 0, problem: "", live: false });
  });

  it("starts and ends where the user marks, in either order", () => {
    timeline.markHere("start");
    expect(timeline.mark).toEqual({ start: 104, end: 110 });
    timeline.setMark({ start: 108, end: 103 });
    expect(timeline.mark).toEqual({ start: 103, end: 108 });
    timeline.markHere("end");
    expect(timeline.mark).toEqual({ start: 103, end: 104 });
  });

  it("is removed with the messages that are dropped", () => {
    timeline.setMark({ start: 103, end: 108 });
    connection.message.emit({ type: "history_extent", start: 105, end: 120, size: 1, max_size: 2 });
    expect(timeline.mark).toEqual({ start: 105, end: 108 });
    connection.message.emit({ type: "history_extent", start: 109, end: 130, size: 1, max_size: 2 });
    expect(timeline.mark).toBeNull();
  });
});
