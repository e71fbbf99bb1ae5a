import assert from "node:assert/strict";
import { test } from "node:test";
import { EventParser } from "../../../service/page/src/api/sse";

const STREAM = "retry: 1000\n\n: ping\n\nevent: state\ndata: {\"a\": 1}\nid: 7\n\nid: 8\nevent: end\ndata: one\ndata: two\n\n";

test("events are read whole, however the stream is cut", () => {
  const whole = new EventParser().push(STREAM);
  assert.deepEqual(whole, [
    { id: "7", event: "state", data: '{"a": 1}' },
    { id: "8", event: "end", data: "one\ntwo" },
  ]);
  for (const length of [1, 2, 5, 13]) {
    const parser = new EventParser();
    const found = [];
    for (let i = 0; i < STREAM.length; i += length) found.push(...parser.push(STREAM.slice(i, i + length)));
    assert.deepEqual(found, whole);
  }
});

test("comments and fields without data make no event", () => {
  assert.deepEqual(new EventParser().push(": ping\n\nid: 3\n\n"), []);
});
