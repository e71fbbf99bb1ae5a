// Fits the sample through the generated client, which sends forms, and prints what it measured.
// node fit.js SERVICE PICTURE REQUEST
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import { eraseFit, getFit, getFitResult, submitFit } from "./client/index.js";
import type { FitRequest } from "./client/index.js";
import { client } from "./client/client.gen.js";

const [service, picture, request] = process.argv.slice(2) as [string, string, string];
client.setConfig({ baseUrl: service, throwOnError: true });

const image = new File([new Uint8Array(await readFile(picture))], basename(picture), { type: "image/jpeg" });
const asked = JSON.parse(await readFile(request, "utf8")) as FitRequest;
let { data: job } = await submitFit<true>({ body: { image, request: asked } });
const path = { fit_id: job.id };
while (job.state === "queued" || job.state === "running") {
  await new Promise((resume) => setTimeout(resume, 300));
  ({ data: job } = await getFit<true>({ path }));
}
if (job.state !== "succeeded") throw new Error(job.problem?.detail ?? job.state);
const { data } = await getFitResult<true>({ path });
const { response } = await eraseFit<true>({ path });
console.log(
  JSON.stringify({
    measurements: Object.fromEntries(data.measurements.map(({ name, value }) => [name, value])),
    erased: response.status,
  }),
);
