// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <filesystem>
#include <iostream>

#include "command_main.hpp"
#include "drawing.hpp"
#include "petal/output.hpp"

/// petal target: draws a target to scale, for who makes it.
int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    CLI::App app("draws a calibration target to scale, for manufacture", "petal target");
    fs::path target;
    fs::path outs[3];
    app.add_option("TARGET", target, "a target file, or the name of one that petal ships")
        ->required();
    auto* formats = app.add_option_group("formats", "one or more");
    formats->add_option("--svg", outs[0], "SVG to write; its page is 1:1");
    formats->add_option("--pdf", outs[1], "PDF to write; print it at 100 %");
    formats->add_option("--dxf", outs[2],
                        "DXF (R12) to write; a unit is a millimetre, layers OUTLINE HOLES PRINT "
                        "DIMENSIONS");
    formats->require_option(1, 3);
    return petal::command_main(app, argc, argv, [&] {
        const petal::Drawing drawing = petal::draw_target(petal::load_target(target));
        std::string (*const writers[])(const petal::Drawing&) = {petal::svg_of, petal::pdf_of,
                                                                 petal::dxf_of};
        for (std::size_t i = 0; i < 3; ++i) {
            if (outs[i].empty()) continue;
            petal::PendingFile file(outs[i]);
            petal::write_file(file.path(), writers[i](drawing));
            file.commit();
            std::cout << outs[i].string() << ": " << petal::millimetres(drawing.page.sizes().x())
                      << " mm x " << petal::millimetres(drawing.page.sizes().y()) << " mm\n";
        }
        return 0;
    });
}
