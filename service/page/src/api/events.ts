// A fit's events to their end, resumed where a connection broke off.
import { request, untilReached } from "./client";
import { EventParser } from "./sse";
import type { EventData } from "./types";

const RECONNECT_MS = 1000;

export async function* fitEvents(path: string, signal: AbortSignal): AsyncGenerator<EventData> {
  let seen = "";
  for (;;) {
    const headers: Record<string, string> = seen === "" ? {} : { "Last-Event-ID": seen };
    const response = await untilReached(() => request(path, { headers, signal }), signal);
    const reader = response.body!.pipeThrough(new TextDecoderStream()).getReader();
    const parser = new EventParser();
    try {
      for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        for (const event of parser.push(value)) {
          seen = event.id;
          yield JSON.parse(event.data) as EventData;
          if (event.event === "end") return;
        }
      }
    } catch (error) {
      if (signal.aborted) throw error;
    } finally {
      void reader.cancel().catch(() => undefined);
    }
    await new Promise((resume) => setTimeout(resume, RECONNECT_MS));
  }
}
