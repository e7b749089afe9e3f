//! Beads as an Apache Parquet table: the columns of the CSV table, for pandas, Polars, DuckDB and Arrow.

use super::table::{COUNTS, Column, KIND, measures};
use super::{Beads, ExportError, Format, Piece};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::sync::Arc;

pub(super) const FORMAT: Format =
    Format { extension: "parquet", purpose: "a table of all pieces, for pandas, Polars and DuckDB", write };

/// Number of rows that are written together.
const GROUP: usize = 1 << 20;

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let (pieces, measures) = (beads.pieces(), measures(beads));
    let properties =
        WriterProperties::builder().set_created_by(concat!("Beadwright ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(&measures)?, Arc::new(properties.build()))?;
    for rows in pieces.chunks(GROUP) {
        let mut group = writer.next_row_group()?;
        columns(&mut group, rows, &measures)?;
        group.close()?;
    }
    Ok(writer.into_inner()?)
}

fn schema(measures: &[&Column]) -> Result<TypePtr, ParquetError> {
    let field = |name: &str, kind: Physical, meaning: Option<LogicalType>| {
        let field = Type::primitive_type_builder(name, kind).with_repetition(Repetition::REQUIRED);
        field.with_logical_type(meaning).build().map(Arc::new)
    };
    let counts = COUNTS.iter().map(|(name, _)| field(name, Physical::INT32, None));
    let kind = field(KIND, Physical::BYTE_ARRAY, Some(LogicalType::String));
    let measures = measures.iter().map(|column| field(column.name, Physical::DOUBLE, None));
    let fields = counts.chain([kind]).chain(measures).collect::<Result<Vec<_>, _>>()?;
    Type::group_type_builder("pieces").with_fields(fields).build().map(Arc::new)
}

/// Writes the columns of some rows, in the order of the schema.
fn columns(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    rows: &[Piece],
    measures: &[&Column],
) -> Result<(), ParquetError> {
    let mut counts = COUNTS.iter();
    let mut measures = measures.iter();
    let mut number = 0;
    while let Some(mut column) = group.next_column()? {
        if let Some((_, count)) = counts.next() {
            let values: Vec<i32> = rows.iter().map(|piece| count(piece) as i32).collect();
            column.typed::<Int32Type>().write_batch(&values, None, None)?;
        } else if number == COUNTS.len() {
            let values: Vec<ByteArray> = rows.iter().map(|piece| piece.kind.name().into()).collect();
            column.typed::<ByteArrayType>().write_batch(&values, None, None)?;
        } else if let Some(measure) = measures.next() {
            let values: Vec<f64> = rows.iter().map(measure.value).collect();
            column.typed::<DoubleType>().write_batch(&values, None, None)?;
        }
        column.close()?;
        number += 1;
    }
    Ok(())
}
