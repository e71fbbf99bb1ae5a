// Fits the sample through the generated client and prints what came of it as JSON.
// node fit.js SERVICE PICTURE REQUEST, once with the picture in the form, once uploaded before.
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import createClient from "openapi-fetch";
import type { components, paths } from "./schema.js";

const [service, picture, request] = process.argv.slice(2) as [string, string, string];
const { GET, POST, DELETE } = createClient<paths>({ baseUrl: service });

function told<T>(data: T | undefined, error: components["schemas"]["Problem"] | undefined): T {
  if (data === undefined) throw new Error(error?.detail ?? "no answer");
  return data;
}

type Job = components["schemas"]["Job"];

const image = new Blob([new Uint8Array(await readFile(picture))], { type: "image/jpeg" });
const asked = JSON.parse(await readFile(request, "utf8")) as components["schemas"]["FitRequest"];

async function submittedAsForm(): Promise<Job> {
  const { data, error } = await POST("/v1/fits", {
    body: { image: basename(picture), request: asked },
    bodySerializer: () => {
      const form = new FormData();
      form.append("image", image, basename(picture));
      form.append("request", JSON.stringify(asked));
      return form;
    },
  });
  return told(data, error);
}

async function submittedAsJson(image_id: string): Promise<Job> {
  const { data, error } = await POST("/v1/fits", { body: { image_id, ...asked } });
  return told(data, error);
}

async function uploaded(): Promise<components["schemas"]["UploadedImage"]> {
  const { data, error } = await POST("/v1/images", {
    body: { image: basename(picture) },
    bodySerializer: () => {
      const form = new FormData();
      form.append("image", image, basename(picture));
      return form;
    },
  });
  return told(data, error);
}

async function measured(job: Job): Promise<Record<string, number>> {
  const path = { fit_id: job.id };
  while (job.state === "queued" || job.state === "running") {
    await new Promise((resume) => setTimeout(resume, 300));
    const { data, error } = await GET("/v1/fits/{fit_id}", { params: { path } });
    job = told(data, error);
  }
  if (job.state !== "succeeded") throw new Error(job.problem?.detail ?? job.state);
  const { data, error } = await GET("/v1/fits/{fit_id}/result", { params: { path } });
  return Object.fromEntries(told(data, error).measurements.map(({ name, value }) => [name, value]));
}

const kept = await uploaded();
const jobs = [await submittedAsForm(), await submittedAsJson(kept.id)] as const;
const measurements = [await measured(jobs[0]), await measured(jobs[1])];
const path = { fit_id: jobs[0].id };
const file = await GET("/v1/fits/{fit_id}/artifacts/{name}", {
  params: { path: { ...path, name: "body_posed.glb" } },
  parseAs: "arrayBuffer",
});
const glb = new Uint8Array(told(file.data, file.error) as ArrayBuffer);
const followed = await GET("/v1/fits/{fit_id}/events", { params: { path }, parseAs: "text" });
const events: string = told(followed.data, followed.error);
const erased: number[] = [];
for (const { id } of jobs) {
  const { response } = await DELETE("/v1/fits/{fit_id}", { params: { path: { fit_id: id } } });
  erased.push(response.status);
}
const { response } = await DELETE("/v1/images/{image_id}", { params: { path: { image_id: kept.id } } });
erased.push(response.status);
console.log(
  JSON.stringify({
    measurements,
    glb: new TextDecoder().decode(glb.slice(0, 4)),
    ends: events.split("event: end").length - 1,
    erased,
  }),
);

// The types are those of the document, not `any`: each of these must be an error.
// @ts-expect-error there is no such state
if (jobs[0].state === "finished") throw new Error();
// @ts-expect-error there is no such path
export const elsewhere = () => GET("/v1/fit");
// @ts-expect-error a gender is needed
export const nobody: components["schemas"]["BodyRequest"] = {};
