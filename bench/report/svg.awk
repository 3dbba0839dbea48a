# svg.awk - marks of charts as SVG text: lines, words, boxes, markers. One picture at a time; coordinates in pixels, y down. Used by bench/report.sh.
# Every number is printed with two decimals, so that the same rows give the same bytes with any awk.
# SPDX-License-Identifier: BSD-2-Clause

# file: where the picture goes when it is closed.
function svg_open(file, width, height, title) {
    svg_file = file
    svg_n = 0
    svg_put("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" width "\" height=\"" height "\" viewBox=\"0 0 " width " " height \
        "\" font-family=\"DejaVu Sans, Verdana, Helvetica, Arial, sans-serif\" role=\"img\">")
    svg_put("<title>" svg_escape(title) "</title>")
    svg_put("<rect width=\"" width "\" height=\"" height "\" fill=\"#ffffff\"/>")
}

function svg_put(text) { svg_line_text[++svg_n] = text }

function svg_close(    i) {
    svg_put("</svg>")
    for (i = 1; i <= svg_n; i++)
        print svg_line_text[i] >svg_file
    close(svg_file)
}

function svg_escape(text) {
    gsub(/&/, "\\&amp;", text)
    gsub(/</, "\\&lt;", text)
    gsub(/>/, "\\&gt;", text)
    return text
}

function px(v) { return sprintf("%.2f", v) }

function svg_line(x1, y1, x2, y2, colour, width, dash) {
    svg_put("<line x1=\"" px(x1) "\" y1=\"" px(y1) "\" x2=\"" px(x2) "\" y2=\"" px(y2) "\" stroke=\"" colour "\" stroke-width=\"" width "\"" \
        svg_dash(dash) "/>")
}

function svg_dash(dash) { return dash == "" ? "" : " stroke-dasharray=\"" dash "\"" }

# anchor: start, middle, end. turn: 1 for words that run upwards.
function svg_write(x, y, text, anchor, size, colour, bold, turn) {
    svg_put("<text x=\"" px(x) "\" y=\"" px(y) "\" text-anchor=\"" anchor "\" font-size=\"" size "\" fill=\"" colour "\"" \
        (bold ? " font-weight=\"bold\"" : "") (turn ? " transform=\"rotate(-90 " px(x) " " px(y) ")\"" : "") ">" svg_escape(text) "</text>")
}

# Words on a white halo, for those that stand among data.
function svg_note(x, y, text, anchor, colour) {
    svg_put("<text x=\"" px(x) "\" y=\"" px(y) "\" text-anchor=\"" anchor "\" font-size=\"11\" fill=\"" colour \
        "\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\">" svg_escape(text) "</text>")
}

# Width of words of a size, roughly; bytes that continue a character of UTF-8 count too.
function svg_width(text, size) { return length(text) * size * 0.57 }

function svg_box(x, y, width, height, fill, stroke) {
    svg_put("<rect x=\"" px(x) "\" y=\"" px(y) "\" width=\"" px(width) "\" height=\"" px(height) "\" fill=\"" fill "\"" \
        (stroke == "" ? "" : " stroke=\"" stroke "\"") "/>")
}

# A line through n points.
function svg_polyline(n, x, y, colour, width, dash,    i, points) {
    for (i = 1; i <= n; i++)
        points = points (i > 1 ? " " : "") px(x[i]) "," px(y[i])
    svg_put("<polyline points=\"" points "\" fill=\"none\" stroke=\"" colour "\" stroke-width=\"" width \
        "\" stroke-linejoin=\"round\" stroke-linecap=\"round\"" svg_dash(dash) "/>")
}

# kind: circle square triangle diamond down cross ring none. Of about r pixels around its centre; a white edge keeps neighbours apart.
function svg_marker(kind, x, y, r, colour,    edge) {
    edge = "\" stroke=\"#ffffff\" stroke-width=\"1\"/>"
    if (kind == "circle")
        svg_put("<circle cx=\"" px(x) "\" cy=\"" px(y) "\" r=\"" px(r) "\" fill=\"" colour edge)
    else if (kind == "ring")
        svg_put("<circle cx=\"" px(x) "\" cy=\"" px(y) "\" r=\"" px(r) "\" fill=\"#ffffff\" stroke=\"" colour "\" stroke-width=\"2\"/>")
    else if (kind == "square")
        svg_polygon(x, y, r * 0.9, "-1 -1 1 -1 1 1 -1 1", colour edge)
    else if (kind == "triangle")
        svg_polygon(x, y, r * 1.15, "0 -1 1 0.8 -1 0.8", colour edge)
    else if (kind == "down")
        svg_polygon(x, y, r * 1.15, "0 1 1 -0.8 -1 -0.8", colour edge)
    else if (kind == "diamond")
        svg_polygon(x, y, r * 1.3, "0 -1 1 0 0 1 -1 0", colour edge)
    else if (kind == "cross") {
        svg_line(x - r, y - r, x + r, y + r, colour, 2.4)
        svg_line(x - r, y + r, x + r, y - r, colour, 2.4)
    }
}

# corners: x y pairs in units of r around the centre.
function svg_polygon(x, y, r, corners, rest,    n, i, c, points) {
    n = split(corners, c, " ")
    for (i = 1; i < n; i += 2)
        points = points (i > 1 ? " " : "") px(x + r * c[i]) "," px(y + r * c[i + 1])
    svg_put("<polygon points=\"" points "\" fill=\"" rest)
}
