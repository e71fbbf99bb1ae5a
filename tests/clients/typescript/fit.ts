// Fits pictures through the generated client and prints what came of it as JSON.
// node fit.js SERVICE REQUEST PICTURE..., once with the pictures in the form, once uploaded before.
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import createClient from "openapi-fetch";
import type { components, paths } from "./schema.js";

const [service, request, ...pictures] = process.argv.slice(2) as [string, string, ...string[]];
const { GET, POST, DELETE } = createClient<paths>({ baseUrl: service });

function told<T>(data: T | undefined, error: components["schemas"]["Problem"] | undefined): T {
  if (data === undefined) throw new Error(error?.detail ?? "no answer");
  return data;
}

type Fit = components["schemas"]["Fit"];

interface Found {
  measurements: Record<string, number>;
  views: (components["schemas"]["ViewKind"] | null)[];
}

async function withPictures(form: FormData, sent: string[]): Promise<FormData> {
  for (const picture of sent) {
    const content = new Uint8Array(await readFile(picture));
    form.append("image", new Blob([content], { type: "image/jpeg" }), basename(picture));
  }
  return form;
}

const asked = JSON.parse(await readFile(request, "utf8")) as components["schemas"]["FitRequest"];

async function submittedAsForm(): Promise<Fit> {
  const form = await withPictures(new FormData(), pictures);
  form.append("request", JSON.stringify(asked));
  const { data, error } = await POST("/v1/fits", {
    body: { image: pictures, request: asked },
    bodySerializer: () => form,
  });
  return told(data, error);
}

async function submittedById(images: string[]): Promise<Fit> {
  const views = (asked.views ?? []).map((view, place) => ({ ...view, image_id: images[place] ?? null }));
  const form = new FormData();
  form.append("request", JSON.stringify({ ...asked, views }));
  const { data, error } = await POST("/v1/fits", { body: { request: { ...asked, views } }, bodySerializer: () => form });
  return told(data, error);
}

async function uploaded(picture: string): Promise<string> {
  const form = await withPictures(new FormData(), [picture]);
  const { data, error } = await POST("/v1/images", { body: { image: picture }, bodySerializer: () => form });
  return told(data, error).id;
}

async function found(fit: Fit): Promise<Found> {
  const path = { fit_id: fit.id };
  while (fit.state === "queued" || fit.state === "running") {
    await new Promise((resume) => setTimeout(resume, 300));
    const { data, error } = await GET("/v1/fits/{fit_id}", { params: { path } });
    fit = told(data, error);
  }
  if (fit.state !== "succeeded") throw new Error(fit.problem?.detail ?? fit.state);
  const { data, error } = await GET("/v1/fits/{fit_id}/result", { params: { path } });
  const { measurements, views } = told(data, error);
  return {
    measurements: Object.fromEntries(measurements.map(({ name, value }) => [name, value])),
    views: views.map(({ view }) => view),
  };
}

const images: string[] = [];
for (const picture of pictures) images.push(await uploaded(picture));
const fits = [await submittedAsForm(), await submittedById(images)] as const;
const results = [await found(fits[0]), await found(fits[1])] as const;
const path = { fit_id: fits[0].id };
const file = await GET("/v1/fits/{fit_id}/files/{name}", {
  params: { path: { ...path, name: "views/0/body_posed.glb" } },
  parseAs: "arrayBuffer",
});
const glb = new Uint8Array(told(file.data, file.error) as ArrayBuffer);
const followed = await GET("/v1/fits/{fit_id}/events", { params: { path }, parseAs: "text" });
const events: string = told(followed.data, followed.error);
const erased: number[] = [];
for (const { id } of fits) {
  const { response } = await DELETE("/v1/fits/{fit_id}", { params: { path: { fit_id: id } } });
  erased.push(response.status);
}
for (const image_id of images) {
  const { response } = await DELETE("/v1/images/{image_id}", { params: { path: { image_id } } });
  erased.push(response.status);
}
console.log(
  JSON.stringify({
    measurements: results.map(({ measurements }) => measurements),
    views: results[0].views,
    glb: new TextDecoder().decode(glb.slice(0, 4)),
    ends: events.split("event: end").length - 1,
    erased,
  }),
);

// The types are those of the document, not `any`: each of these must be an error.
// @ts-expect-error there is no such state
if (fits[0].state === "finished") throw new Error();
// @ts-expect-error there is no such path
export const elsewhere = () => GET("/v1/fit");
// @ts-expect-error a gender is needed
export const nobody: components["schemas"]["BodyRequest"] = {};
