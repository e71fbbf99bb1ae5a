import{a as x}from"/page/chunk.F7QV4RXS.js";import{b as v}from"/page/chunk.5TUMT73T.js";import"/page/chunk.TADDU3B6.js";import{a as O}from"/page/chunk.UC5CUJKN.js";import"/page/chunk.BKISLWAV.js";import{B as k,i as A,p as S,x as T}from"/page/chunk.HHH4RJPV.js";import{a as _}from"/page/chunk.6D5M2MCG.js";import{d as E,m as u,o as t}from"/page/chunk.XR7ZMISG.js";import"/page/chunk.OTD3EZO2.js";import{k as f}from"/page/chunk.UN3AK7H4.js";import"/page/chunk.4YB65RXQ.js";import"/page/chunk.F5XGFZ2T.js";var b={curl:({origin:e,name:r,isSample:o,request:s,hasKey:a})=>{let i=`curl -sf${a?' -H "Authorization: Bearer $MAQUETTE_API_KEY"':""}`,l=o?r:`"${r.replace(/["\\]/g,"\\$&")}"`;return`${o?`curl -sfO ${e}/page/${r}
`:""}FIT=$(${i} -H 'Prefer: wait=60' \\
  -F ${P(`image=@${l}`)} \\
  -F ${P(`request=${s}`)} \\
  -o /dev/null -w '%header{location}' ${e}/v1/fits)
${i} ${e}$FIT/result`},fetch:({origin:e,name:r,isSample:o,request:s,hasKey:a})=>`const { openAsBlob } = await import("node:fs");
const service = "${e}";
const picture = await ${o?`(await fetch(service + "/page/${r}")).blob()`:`openAsBlob(${JSON.stringify(r)})`};
const headers = { Prefer: "wait=60"${a?", Authorization: `Bearer ${process.env.MAQUETTE_API_KEY}`":""} };

const body = new FormData();
body.append("image", picture);
body.append("request", JSON.stringify(${s}));
const answer = await fetch(service + "/v1/fits", { method: "POST", headers, body });
const fit = await answer.json();
if (fit.state !== "succeeded") throw new Error(JSON.stringify(fit));
const result = await fetch(service + fit.links.result, { headers });
console.log(await result.text());`.replace(o?/^.*\n/:"",""),python:({origin:e,name:r,isSample:o,request:s,hasKey:a})=>`${a?`import os

`:""}import httpx

service = "${e}"
picture = ${o?`httpx.get(service + "/page/${r}").content`:`open(${JSON.stringify(r)}, "rb").read()`}
headers = {"Prefer": "wait=60"${a?', "Authorization": "Bearer " + os.environ["MAQUETTE_API_KEY"]':""}}

with httpx.Client(base_url=service, headers=headers, timeout=90) as client:
    data = {"request": r'''${s}'''}
    answer = client.post("/v1/fits", files={"image": picture}, data=data)
    fit = answer.raise_for_status().json()
    print(client.get(fit["links"]["result"]).raise_for_status().text)`};function P(e){return`'${e.replaceAll("'","'\\''")}'`}var N="sample.jpg",C=h({gender:"male",height_m:1.804,views:[{view:"front"}]}),q=h({gender:null,height_m:null,views:[{view:"front"}]});function Y(){let{trying:e}=f,r=u(null),o=u(C),s=u(null),a=u(void 0),i=u(null),l=u("curl");E(()=>()=>i.value?.abort(),[]);let d=(n,c=r.value)=>{i.value?.abort(),i.value=s.value=null,a.value=void 0,o.value=n,r.value=c},y=async()=>{d(o.value);let{signal:n}=i.value=new AbortController,c=null;try{let g=r.value??await(await fetch(`/page/${N}`)).blob(),p=await T(g,F(o.value),n);c=p.state==="succeeded"?await k(p.id):p,n.aborted||(a.value=p.links.files["body_canonical.glb"])}catch(g){c=S(g)}n.aborted||(s.value=c,i.value=null,v(e.answered))},w=n=>n&&d(q,n),$={origin:location.origin,name:r.value?.name??N,isSample:r.value===null,request:F(o.value),hasKey:A.value!==null};return t("main",{class:"try",onDragOver:n=>n.preventDefault(),onDrop:n=>{n.preventDefault(),w(n.dataTransfer?.files[0])},children:[t("section",{children:[t("h1",{children:e.title}),t("p",{class:"row",children:[t("button",{class:"button is-primary",type:"button",onClick:()=>(d(C,null),void y()),children:e.sample}),t(O,{look:"button",onChoose:([n])=>w(n),children:e.choose})]}),t(m,{label:e.request($.name),text:o.value,rows:11,onEdit:d}),t("button",{class:"button",type:"button",disabled:i.value!==null,onClick:()=>{y()},children:i.value?f.frame.sending:e.send}),t(_,{name:"language",legend:e.as,quiet:!0,options:Object.keys(b).map(n=>({value:n,label:e.languages[n]})),value:l.value,onChange:n=>l.value=n}),t(m,{label:e.languages[l.value],text:b[l.value]($),rows:16})]}),t("section",{"aria-busy":i.value!==null,children:t(m,{label:e.response,text:s.value?h(s.value):"",rows:36})}),t("section",{children:[t("h2",{children:e.body}),a.value&&t(x,{path:a.value,label:e.body},a.value),t("a",{href:"/docs",children:e.reference})]})]})}function m({label:e,text:r,rows:o,onEdit:s}){let{copy:a,copied:i}=f.trying;return t("div",{class:"try-code",children:[t("h2",{children:e}),t("button",{class:"link",type:"button",onClick:()=>{navigator.clipboard.writeText(r).then(()=>v(i))},children:a(e)}),t("textarea",{"aria-label":e,rows:o,wrap:"off",spellcheck:!1,readOnly:!s,value:r,onInput:l=>s?.(l.currentTarget.value)})]})}function h(e){return JSON.stringify(e,null,2)}function F(e){try{return JSON.stringify(JSON.parse(e))}catch{return e}}export{Y as TryView};
