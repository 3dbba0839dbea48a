-- anchors.lua - pandoc filter for the specification: an anchor for each rule where it is defined, a link from every other mention, anchors
-- s5.1 for numbered sections, links between files as HTML, tables as wide as their content.
-- The environment variable SPEC_RULES names a file of lines "R-ABC-nnn page.html".
-- SPDX-License-Identifier: BSD-2-Clause
local page = {}
for line in io.lines(os.getenv("SPEC_RULES")) do
  local rule, file = line:match("^(%S+) (%S+)$")
  page[rule] = file
end

local function rule_of(inline)
  return inline.t == "Strong" and #inline.content == 1 and inline.content[1].t == "Str" and page[inline.content[1].text] and inline.content[1].text
end

local function mentions(el)
  local out, rest, found = {}, el.text, false
  while true do
    local a, b = rest:find("R%-%u%u%u%-%d%d%d")
    local rule = a and rest:sub(a, b)
    if not rule or not page[rule] then break end
    found = true
    if a > 1 then table.insert(out, pandoc.Str(rest:sub(1, a - 1))) end
    table.insert(out, pandoc.Link(pandoc.Str(rule), page[rule] .. "#" .. rule))
    rest = rest:sub(b + 1)
  end
  if not found then return nil end
  if rest ~= "" then table.insert(out, pandoc.Str(rest)) end
  return out
end

local linker = { Str = mentions, Link = function(el) return el end }

local function paragraph(el)
  local first = el.content[1]
  local rule = first and rule_of(first)
  if not rule then return el:walk(linker) end
  local rest = pandoc.Para({ table.unpack(el.content, 2) }):walk(linker)
  local span = pandoc.Link(pandoc.Str(rule), "#" .. rule, "", { id = rule, class = "rule" })
  return pandoc.Para({ span, table.unpack(rest.content) })
end

return {
  {
    Header = function(el)
      local text = pandoc.utils.stringify(el)
      local number = text:match("^Annex ([A-Z])%s") or text:match("^([%dA-Z][%d%.]*)%s")
      if number then el.identifier = "s" .. number end
      return el
    end,
    Link = function(el)
      el.target = el.target:gsub("^README%.md", "index.html"):gsub("^%.%./CHANGELOG%.md", "CHANGELOG.html"):gsub("^([%w%-]+)%.md", "%1.html")
      return el
    end,
    Table = function(el)
      for _, c in ipairs(el.colspecs) do c[2] = nil end
      return el
    end,
  },
  {
    Para = paragraph,
    Plain = function(el) return el:walk(linker) end,
  },
}
